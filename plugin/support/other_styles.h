#pragma once
// The engines' styles as they go with the plugin: which are right beside its contact laws and fixes, which
// are refused, and which have not been tried. plugin/doc/with_other_styles.md has the same lists with
// reasons, and a test compares the two. No engine is needed here.

#include <string>
#include <string_view>

namespace drumlin {

/// What the set-up of a run does about a style in a deck.
enum class Verdict {
  right,   ///< nothing: a test shows that the results are right
  untried, ///< a warning: no test has tried it
  refused, ///< ends the run
};

/// Fixes that are treated alike.
struct OtherFixes {
  const char *what;       ///< they do beside the plugin, as an error or a warning says it
  Verdict second, stock;  ///< with the scheme of this name
  std::string_view names; ///< separated by spaces
};

constexpr OtherFixes other_fixes[] = {
    {"is part of the plugin", Verdict::right, Verdict::right,
     "bond/spring boundary/absorb clump contact/energy contact/events contact/local contact/way "
     "drum/excite drum/travel guard roller/history wall/gran/transition"},
    {"computes, stores or writes", Verdict::right, Verdict::right,
     "ave/atom ave/chunk ave/correlate ave/correlate/long ave/euler ave/euler/stress ave/grid ave/histo "
     "ave/histo/weight ave/moments ave/spatial ave/spatial/sphere ave/time check/timestep/gran "
     "contacthistory contacthistory/mesh contactproperty/atom contactproperty/atom/wall controller "
     "custom_property/global deform/check diam/max graphics/arrows graphics/chunk graphics/isosurface "
     "graphics/labels graphics/lines graphics/objects graphics/periodic graphics/replica halt massflow/mesh "
     "neighlist/mesh nonaffine/displacement pair pair/tracker particledistribution/discrete "
     "particledistribution/discrete/massbased particledistribution/discrete/numberbased "
     "particletemplate/multiplespheres particletemplate/multisphere particletemplate/sphere print "
     "property/atom property/atom/regiontracer/time property/atom/timetracer property/atom/tracer "
     "property/atom/tracer/stream property/atomtype property/atomtypepair property/global region/variable "
     "store/force store/state vector"},
    {"adds forces or takes them away", Verdict::right, Verdict::right,
     "addforce aveforce buoyancy drag freeze gravity indent lineforce planeforce setforce spring spring/self "
     "viscous wall/harmonic wall/lj1043 wall/lj126 wall/lj93 wall/morse wall/region"},
    {"integrates, moves or changes balls, the box or the time step", Verdict::right, Verdict::right,
     "adapt deform dt/reset move nve nve/noforce nve/sphere"},
    {"is a wall, at rest or moving", Verdict::right, Verdict::right,
     "mesh/surface mesh/surface/planar mesh/surface/stress mesh/surface/stress/servo move/mesh "
     "move/mesh/file move/mesh/gran wall/gran wall/gran/region"},
    {"inserts balls or shares them out among the ranks", Verdict::right, Verdict::right,
     "balance insert/pack insert/rate/region insert/stream pour"},
    {"makes rigid bodies", Verdict::refused, Verdict::right, "rigid rigid/nve rigid/nve/small rigid/small"},
    {"changes velocities, positions or the forces of contacts beside the integration", Verdict::refused,
     Verdict::right,
     "ehex flow/gauss heat langevin momentum momentum/chunk nph nph/sphere npt npt/sphere nve/limit nvt "
     "nvt/sllod nvt/sphere press/berendsen recenter temp/berendsen temp/csld temp/csvr temp/rescale "
     "thermal/conductivity viscosity wall/piston wall/reflect wall/reflect/stochastic"},
    {"changes velocities or the box beside the integration", Verdict::refused, Verdict::untried,
     "damping/cundall press/langevin"},
    {"computes the forces of a step more than once", Verdict::refused, Verdict::refused,
     "numdiff numdiff/virial"},
    {"has not been tried with the plugin", Verdict::untried, Verdict::untried,
     "accelerate/cos acks2/reax acks2/reaxff adapt/fep add/heat addtorque addtorque/atom addtorque/group "
     "alchemy align/self amoeba/bitorsion amoeba/pitorsion append/atoms atc atom/swap atom_weight/apip baoab "
     "bocs bond/break bond/create bond/create/angle bond/react bond/swap box/relax brownian brownian/asphere "
     "brownian/sphere charge/regulation check/timestep/sph client/md cmap colvars concave continuum/weighted "
     "couple/cfd couple/cfd/convection couple/cfd/convectiveImpl couple/cfd/dragforce couple/cfd/force "
     "couple/cfd/force/implicit couple/cfd/radiation couple/cfd/speciesConvection couple/lb/onetoone "
     "deform/pressure deposit dpd/energy drude drude/transform/direct drude/transform/inverse edpd/source "
     "efield efield/lepton efield/tip4p electrode/conp electrode/conq electrode/thermo electron/stopping "
     "electron/stopping/fit enforce2d eos/cv eos/table eos/table/rx evaporate external ffl "
     "fiber/spring/simple filter/corotate gcmc gemc gjf gld gle grem heat/flow heat/gran "
     "heat/gran/conduction hmc hyper/global hyper/local ilves imd ipi lambda/apip lambda/la/csp/apip "
     "lambda_thermostat/apip langevin/drude langevin/eff langevin/spin latte lb/fluid lb/momentum lb/pc "
     "lb/rigid/pc/sphere lb/viscous manifoldforce massflow/mesh/sieve mdi/engine mdi/qm mdi/qmmm meso/move "
     "mol/swap mscg msst multicontact/halfspace multisphere multisphere/break multisphere/nointegration "
     "mvv/dpd mvv/edpd mvv/tdpd neb neb/spin neighbor/swap nph/asphere nph/body nph/eff nphug npt/asphere "
     "npt/body npt/cauchy npt/eff npt/uef nve/asphere nve/asphere/noforce nve/awpmd nve/body nve/bpm/sphere "
     "nve/dot nve/dotc/langevin nve/eff nve/line nve/manifold/rattle nve/sph nve/sph/stationary nve/spin "
     "nve/tri nvk nvt/asphere nvt/body nvt/eff nvt/manifold/rattle nvt/sllod/eff nvt/uef oneway orient/bcc "
     "orient/eco orient/fcc pafi phonon pimd pimd/langevin pimd/langevin/bosonic pimd/nvt pimd/nvt/bosonic "
     "plumed poems polarize/bem/gmres polarize/bem/icc polarize/functional precession/spin propel/self "
     "python python/invoke python/move qbmsst qeq/comb qeq/ctip qeq/dynamic qeq/fire qeq/point qeq/reax "
     "qeq/reaxff qeq/rel/reaxff qeq/shielded qeq/slater qmmm qtb qtpie/reaxff rattle reax/c/bonds "
     "reax/c/species reaxff/bonds reaxff/species restrain rheo rheo/oxidation rheo/pressure rheo/thermal "
     "rheo/viscosity rhok rigid/meso rigid/nph rigid/nph/small rigid/npt rigid/npt/small rigid/nvt "
     "rigid/nvt/small rx saed/vtk set setforce/spin settorque/atom sgcmc shake shardlow smd smd/adjust_dt "
     "smd/integrate_tlsph smd/integrate_ulsph smd/move_tri_surf smd/setvel smd/wall_surface sph "
     "sph/density/continuity sph/density/corr sph/density/summation sph/pressure sph/stationary spring/chunk "
     "spring/rg srd surface/global surface/local tdpd/source temp/rescale/eff tfmc tgnpt/drude tgnvt/drude "
     "ti/spring tmd transportequation/scalar ttm ttm/grid ttm/mod ttm/thermal tune/kspace viscous/nonlinear "
     "viscous/sphere wall/body/polygon wall/body/polyhedron wall/colloid wall/ees wall/flow "
     "wall/harmonic/outside wall/harmonic/returned wall/lepton wall/region/ees wall/region/sph wall/sph "
     "wall/srd wall/table widom"},
};

/// Run styles and atom styles with which the results are right; others are refused, and untried.
constexpr std::string_view right_run_styles = "verlet";
constexpr std::string_view right_atom_styles = "granular sphere";
/// Commands that compute forces otherwise than step by step in time.
constexpr std::string_view refused_commands =
    "dynamical_matrix hyper minimize neb neb/spin prd rerun tad temper temper/grem temper/npt third_order";

/// A style without the suffix of its OpenMP or optimized variant, which does the same.
constexpr std::string_view without_suffix(std::string_view style) {
  for (const std::string_view suffix : {std::string_view("/omp"), std::string_view("/opt")})
    if (style.size() > suffix.size() && style.substr(style.size() - suffix.size()) == suffix)
      return style.substr(0, style.size() - suffix.size());
  return style;
}

/// Whether a list of names, separated by spaces, has a name.
constexpr bool has_name(std::string_view names, std::string_view name) {
  while (!names.empty()) {
    const std::size_t space = names.find(' ');
    if (names.substr(0, space) == name) return true;
    names = space == std::string_view::npos ? std::string_view() : names.substr(space + 1);
  }
  return false;
}

/// The fixes that a style belongs to; nullptr for a style on no list.
inline const OtherFixes *other_fixes_with(std::string_view style) {
  for (const OtherFixes &fixes : other_fixes)
    if (has_name(fixes.names, without_suffix(style))) return &fixes;
  return nullptr;
}

/// Fixes that change the time step within a run.
inline bool changes_time_step(std::string_view style) {
  return has_name("dt/reset smd/adjust_dt", without_suffix(style));
}

} // namespace drumlin
