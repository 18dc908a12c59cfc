#include "bed/known_gradings.h"

#include <algorithm>

namespace drumlin::post {

SieveCurve KnownGrading::curve() const {
  std::vector<Sieve> sieves;
  for (const SieveLimits &at : limits)
    sieves.push_back({at.size * 1e-3, 0.5 * (at.lower + at.upper) / 100.0});
  return SieveCurve(std::move(sieves));
}

const std::vector<KnownGrading> &known_gradings() {
  static const std::vector<KnownGrading> gradings = {
      {"M147-B",
       "soil-aggregate for base courses, 0 to 50 mm",
       "AASHTO M 147, Table 1, grading B, as a laboratory's form for sieve analyses has it (weight sieve "
       "bands, AASHTO_M147_B)",
       {{0.075, 5, 20},
        {0.425, 15, 30},
        {2, 20, 45},
        {4.75, 30, 60},
        {9.5, 40, 75},
        {25, 75, 95},
        {50, 100, 100}}},
      {"PM1-20",
       "crushed rock for base courses, 0 to 26.5 mm",
       "South Australia, Part 215, PM1/20, as sustainableaggregates.com.au/spec_compliance.php has it (its "
       "sieves 0.43 and 0.08 mm are those of 0.425 and 0.075 mm)",
       {{0.075, 5, 11},
        {0.425, 13, 23},
        {2.36, 29, 49},
        {4.75, 44, 64},
        {9.5, 63, 83},
        {13.2, 77, 93},
        {19, 95, 100},
        {26.5, 100, 100}}},
      {"WMM",
       "wet mix macadam, crushed stone for base courses, 0 to 53 mm",
       "India, MoRTH specifications, fifth revision, Table 400-13, as "
       "constructionblogs.in/wet-mix-macadam-wmm has it; an earlier edition has 0 to 8 % at 0.075 mm",
       {{0.075, 0, 5},
        {0.6, 8, 22},
        {2.36, 15, 30},
        {4.75, 25, 40},
        {11.2, 40, 60},
        {22.4, 60, 80},
        {45, 95, 100},
        {53, 100, 100}}},
  };
  return gradings;
}

const KnownGrading *find_grading(const std::string &name) {
  const std::vector<KnownGrading> &all = known_gradings();
  const auto found =
      std::find_if(all.begin(), all.end(), [&name](const KnownGrading &g) { return name == g.name; });
  return found == all.end() ? nullptr : &*found;
}

std::string grading_names() {
  std::string names;
  for (const KnownGrading &grading : known_gradings())
    names += (names.empty() ? "" : ", ") + std::string(grading.name);
  return names;
}

} // namespace drumlin::post
