#include "lammps/fix_wall_gran_transition.h"

#include "contact/contact_forces.h"
#include "lammps/pair_gran_transition.h"

#include <algorithm>
#include <cmath>

#include "region_cone.h"
#include "region_intersect.h"
#include "region_union.h"

using namespace LAMMPS_NS;
using drumlin::FrictionModel;
namespace physics = drumlin::physics;

namespace {

constexpr const char *command = "fix wall/gran/transition";

// Private members of the engine's regions. C++ allows an explicit instantiation to name a private member as a
// template argument; the friend function of the instance gives access to it.
template <auto Member>
struct ConeAccess {
  friend auto &axis_of(RegCone &cone) { return cone.*Member; }
};
auto &axis_of(RegCone &cone);
template struct ConeAccess<&RegCone::axis>;
template <auto Member>
struct UnionAccess {
  friend auto &parts_of(RegUnion &region) { return region.*Member; }
};
auto &parts_of(RegUnion &region);
template struct UnionAccess<&RegUnion::idsub>;
template <auto Member>
struct IntersectAccess {
  friend auto &parts_of(RegIntersect &region) { return region.*Member; }
};
auto &parts_of(RegIntersect &region);
template struct IntersectAccess<&RegIntersect::idsub>;

/// The cone along y in a region, or in its parts, whose flat ends act on balls inside of it; nullptr if there
/// is none. The engine gives these ends a direction along z: a wall from them makes energy.
/// \param outside whether the wall is the outer side of the region
const Region *broken_cone(Domain *domain, Region *region, bool outside) {
  if (region == nullptr) return nullptr;
  const bool of_inside = (region->interior != 0) != outside;
  const auto among = [&](char **parts) -> const Region * {
    for (int n = 0; n < region->nregion; ++n)
      if (const Region *cone =
              broken_cone(domain, drumlin::engine::version::find_region(domain, parts[n]), !of_inside))
        return cone;
    return nullptr;
  };
  if (auto *joined = dynamic_cast<RegUnion *>(region)) return among(parts_of(*joined));
  if (auto *common = dynamic_cast<RegIntersect *>(region)) return among(parts_of(*common));
  auto *cone = dynamic_cast<RegCone *>(region);
  const bool capped = region->openflag == 0 || region->open_faces[0] == 0 || region->open_faces[1] == 0;
  return cone != nullptr && axis_of(*cone) == 'y' && of_inside && capped ? region : nullptr;
}

} // namespace

FixWallGranTransition::FixWallGranTransition(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 3;
  extvector = 1;
  global_freq = 1;
  restart_peratom = 1;
  create_attribute = 1;
  drumlin::Arguments in(error, command, narg - 3, arg + 3);
  type_ = static_cast<int>(in.integer("type of the wall", 1, atom->ntypes));
  const int wall = in.choice("wall", {"xplane", "yplane", "zplane", "region"});
  wall == 3 ? read_region(in) : read_planes(in, wall);
  if (!in.empty())
    in.fail("'" + in.peek() +
            "' is left over; allowed: TYPE xplane|yplane|zplane LOW HIGH or TYPE region ID (the law and its "
            "settings are those of the pair style)");
  FixWallGranTransition::grow_arrays(atom->nmax);
  atom->add_callback(Atom::GROW);
  atom->add_callback(Atom::RESTART);
  for (int i = 0; i < atom->nlocal; ++i)
    FixWallGranTransition::set_arrays(i);
}

void FixWallGranTransition::read_planes(drumlin::Arguments &in, int axis) {
  axis_ = axis;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string what = side == 0 ? "place of the low wall" : "place of the high wall";
    if (!in.empty() && in.peek() == "NULL")
      in.word(what);
    else {
      place_[side] = in.number(what);
      has_[side] = true;
    }
  }
  if (sides() == 0) in.fail("both places are NULL; allowed: a number, in m, for one at least");
  if (sides() == 2 && place_[0] >= place_[1])
    in.fail("the low wall is not below the high one; allowed: LOW < HIGH");
}

void FixWallGranTransition::read_region(drumlin::Arguments &in) {
  region_id_ = in.word("ID of the region");
  const Region *region = drumlin::engine::version::find_region(domain, region_id_);
  if (region == nullptr) in.fail("region '" + region_id_ + "' is unknown; allowed: the ID of a region");
  places_ = region->cmax;
}

FixWallGranTransition::~FixWallGranTransition() {
  atom->delete_callback(id, Atom::GROW);
  atom->delete_callback(id, Atom::RESTART);
  memory->destroy(memory_);
}

int FixWallGranTransition::setmask() { return FixConst::POST_FORCE; }

void FixWallGranTransition::init() {
  pair_ = PairGranTransition::find(lmp);
  if (pair_ == nullptr)
    error->all(FLERR, drumlin::engine::error_text(drumlin::other_pair_style(lmp, command)));
  check_coefficients();
  const drumlin::ContactSettings &settings = pair_->contact_settings();
  stepping_ = settings.stock ? nullptr : FixStepping::find(lmp);
  places_of_side_ = {};
  for (const drumlin::Remembered what : drumlin::history_order)
    if (what == drumlin::Remembered::spring || settings.stores(what)) places_of_side_.add(what);
  if (region_id_.empty()) return;
  const auto refuse = [this](const char *why) {
    error->all(FLERR,
               drumlin::engine::error_text(std::string(command) + ": region '" + region_id_ + "' " + why));
  };
  region_ = drumlin::engine::version::find_region(domain, region_id_);
  if (region_ == nullptr) refuse("is gone; allowed: a region that stays while the fix does");
  if (region_->cmax != places_)
    refuse("has another number of faces than before; allowed: the region that it was");
  if (const Region *cone = broken_cone(domain, region_, false))
    refuse(cone == region_
               ? "is a cone along y, whose flat ends LAMMPS gives another direction; allowed: a cone with "
                 "open 1 open 2 and fixes of their own for its ends, or one along x or z"
               : "has a part that is a cone along y, whose flat ends LAMMPS gives another direction; "
                 "allowed: such a cone with open 1 open 2, or one along x or z");
  if (region_->dynamic_check() != 0) refuse("moves; allowed: a region at rest");
  near_.resize(static_cast<std::size_t>(places_));
}

/// Ends the run if a pair of the wall's type and a type of its balls has no coefficients. (As a part of a
/// hybrid pair style the law need not have coefficients of all pairs of types.)
void FixWallGranTransition::check_coefficients() const {
  std::vector<int> mine(static_cast<std::size_t>(atom->ntypes) + 1, 0);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) mine[static_cast<std::size_t>(atom->type[i])] = 1;
  std::vector<int> all = mine;
  MPI_Allreduce(mine.data(), all.data(), static_cast<int>(all.size()), MPI_INT, MPI_MAX, world);
  for (int type = 1; type <= atom->ntypes; ++type)
    if (all[static_cast<std::size_t>(type)] != 0 && !pair_->has_coefficients(type, type_))
      error->all(FLERR, drumlin::engine::error_text(std::string(command) + ": " +
                                                    pair_->missing_coefficients(type, type_)));
}

void FixWallGranTransition::setup(int vflag) { post_force(vflag); }

void FixWallGranTransition::post_force(int) {
  const VelocitiesOfStep velocities(lmp);
  force_ = {};
  std::visit(
      [this](const auto *table) {
        drumlin::with_models(pair_->contact_settings(), [&](auto stepped, auto tangential, auto rolling) {
          touch_balls<decltype(stepped)::value, decltype(tangential)::value, decltype(rolling)::value>(
              *table);
        });
      },
      pair_->table());
}

template <bool stepped, FrictionModel tangential, bool rolling, class Parameters>
void FixWallGranTransition::touch_balls(const drumlin::CoefficientTable<Parameters> &table) {
  using Forces = drumlin::ContactForces<Parameters, stepped, tangential, rolling, physics::Partner::wall>;
  const drumlin::ContactStep<Parameters> step = pair_->step_of(table, places_of_side_);
  Forces forces(*atom, step);
  const bool rolls = Forces::springs && step.cap == physics::Cap::coulomb && step.slips_in_middle();
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit)) continue;
    region_ != nullptr ? find_faces(i, rolls) : find_planes(i);
    for (const Face &face : faces_)
      touch<Forces>(forces, i, face);
  }
}

void FixWallGranTransition::find_planes(int i) {
  faces_.clear();
  for (int side = 0; side < 2; ++side) {
    const auto n = static_cast<std::size_t>(side);
    if (!has_[n]) continue;
    physics::Vec3 normal{};
    double &up = normal[static_cast<std::size_t>(axis_)];
    up = side == 0 ? 1.0 : -1.0;
    faces_.push_back({side, normal, normal, up * (atom->x[i][axis_] - place_[n])});
  }
}

/// Finds the faces of the region that a ball touches, or is so near that it may have touched them one step
/// ago. \param rolls whether the normals in the middle of the step are needed
void FixWallGranTransition::find_faces(int i, bool rolls) {
  constexpr double near = 1.1; // in radii: in one step a ball moves by less than 0.1 radii
  const double *x = atom->x[i], *v = atom->v[i];
  const auto for_each_face = [&](const physics::Vec3 &at, const auto &treat) {
    const int count = region_->match(at[0], at[1], at[2])
                          ? region_->surface(at[0], at[1], at[2], near * atom->radius[i])
                          : 0;
    for (int n = 0; n < count; ++n) {
      const Region::Contact &face = region_->contact[n];
      treat(face.iwall, physics::Vec3{face.delx / face.r, face.dely / face.r, face.delz / face.r}, face.r);
    }
  };
  faces_.clear();
  std::fill(near_.begin(), near_.end(), false);
  bool touches = false;
  for_each_face({x[0], x[1], x[2]}, [&](int place, const physics::Vec3 &normal, double distance) {
    near_.at(static_cast<std::size_t>(place)) = true;
    faces_.push_back({place, normal, normal, distance});
    touches = touches || distance < atom->radius[i];
  });
  for (int place = 0; place < places_; ++place)
    if (!near_[static_cast<std::size_t>(place)]) std::fill_n(row(i, place), of_a_side, 0.0);
  if (!rolls || !touches) return;
  const physics::Vec3 middle = physics::sum({x[0], x[1], x[2]}, -0.5 * update->dt, {v[0], v[1], v[2]});
  for_each_face(middle, [&](int place, const physics::Vec3 &normal, double) {
    for (Face &face : faces_)
      if (face.place == place) face.normal_in_middle = normal;
  });
}

template <class Forces>
void FixWallGranTransition::touch(Forces &forces, int i, const Face &face) {
  double *const remembered = row(i, face.place); // whether the ball touched, then the history
  drumlin::BlockContact contact{i, -1, 0, face.distance < atom->radius[i], remembered + 1};
  const bool touched = remembered[0] != 0.0;
  if (!contact.touches && !touched) return;
  if constexpr (!Forces::has_history)
    if (!contact.touches) { // the end of a contact that leaves nothing
      remembered[0] = 0.0;
      return;
    }
  forces.take_wall(i, {face.normal,
                       face.normal_in_middle,
                       {},
                       atom->radius[i] - face.distance,
                       pair_->mass_unless_frozen(i),
                       type_});
  forces.take_histories(&contact, 1);
  const std::size_t announced = stepping_ != nullptr ? stepping_->announced() : 0;
  forces.compute(&contact, 1, contact.touches != touched ? 1 : 0, true);
  remembered[0] = contact.touches ? 1.0 : 0.0;
  const physics::Vec3 push = forces.block.total_force[0], torque = forces.torque_i(0);
  for (std::size_t a = 0; a < 3; ++a) {
    atom->f[i][a] += push[a];
    atom->torque[i][a] += torque[a];
  }
  force_ = physics::sum(force_, 1.0, push);
  if (stepping_ == nullptr) return;
  // Half of what acts in the closing half kick, half of what acts in the next opening one.
  force_ = physics::sum(force_, 0.5, stepping_->rest_since(announced));
  if (!contact.touches) return;
  if (auto *coupled = stepping_->coupled_at(contact.history + places_of_side_[drumlin::Remembered::force]))
    coupled->report = [this](const physics::Vec3 &change) { force_ = physics::sum(force_, 1.0, change); };
}

double FixWallGranTransition::compute_vector(int n) {
  double all = 0.0;
  MPI_Allreduce(&force_[static_cast<std::size_t>(n)], &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixWallGranTransition::grow_arrays(int nmax) {
  memory->grow(memory_, nmax, numbers(), "wall/gran/transition:memory");
}

void FixWallGranTransition::copy_arrays(int i, int j, int) { std::copy_n(memory_[i], numbers(), memory_[j]); }

void FixWallGranTransition::set_arrays(int i) { std::fill_n(memory_[i], numbers(), 0.0); }

int FixWallGranTransition::pack_exchange(int i, double *buf) {
  std::copy_n(memory_[i], numbers(), buf);
  return numbers();
}

int FixWallGranTransition::unpack_exchange(int i, double *buf) {
  std::copy_n(buf, numbers(), memory_[i]);
  return numbers();
}

int FixWallGranTransition::pack_restart(int i, double *buf) {
  buf[0] = 1 + numbers();
  std::copy_n(memory_[i], numbers(), buf + 1);
  return 1 + numbers();
}

void FixWallGranTransition::unpack_restart(int i, int nth) {
  const double *values = atom->extra[i]; // the records of all fixes, each with its length first
  for (int n = 0; n < nth; ++n)
    values += static_cast<int>(values[0]);
  const int count = static_cast<int>(values[0]) - 1;
  std::fill_n(memory_[i], numbers(), 0.0);
  for (const int of_file :
       {5, 9, of_a_side}) { // numbers of a side in files of version 0.2.0, of later ones, and of this
    if (count != places_ * of_file) continue;
    for (int place = 0; place < places_; ++place)
      std::copy_n(values + 1 + static_cast<std::ptrdiff_t>(place) * of_file, of_file, row(i, place));
    return;
  }
  error->one(FLERR, drumlin::engine::error_text(std::string(command) +
                                                ": the restart file holds another wall under the ID '" + id +
                                                "'; allowed: the wall that it was, or another ID"));
}

double FixWallGranTransition::memory_usage() {
  return static_cast<double>(atom->nmax) * numbers() * sizeof(double);
}
