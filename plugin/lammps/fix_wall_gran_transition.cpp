#include "lammps/fix_wall_gran_transition.h"

#include "support/arguments.h"
#include "lammps/pair_gran_transition.h"
#include "lammps/rolling_terms.h"

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
  observers_.find(*modify);
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

template <bool stepped, FrictionModel tangential, bool rolling, class Table>
void FixWallGranTransition::touch_balls(const Table &table) {
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit)) continue;
    if (region_ != nullptr) {
      surfaces_of_region(i, [&](int place, const physics::Vec3 &normal, double distance) {
        touch<stepped, tangential, rolling>(table, i, place, normal, distance);
      });
      continue;
    }
    for (int side = 0; side < 2; ++side) {
      const auto n = static_cast<std::size_t>(side);
      if (!has_[n]) continue;
      physics::Vec3 normal{};
      double &up = normal[static_cast<std::size_t>(axis_)];
      up = side == 0 ? 1.0 : -1.0;
      touch<stepped, tangential, rolling>(table, i, side, normal, up * (atom->x[i][axis_] - place_[n]));
    }
  }
}

/// Calls touch(place, normal, distance) for each face of the region that a ball touches, or is so near that
/// it may have touched it one step ago.
template <class Touch>
void FixWallGranTransition::surfaces_of_region(int i, Touch &&touch) {
  constexpr double near = 1.1; // in radii: in one step a ball moves by less than 0.1 radii
  const double *x = atom->x[i];
  std::fill(near_.begin(), near_.end(), false);
  const int faces =
      region_->match(x[0], x[1], x[2]) ? region_->surface(x[0], x[1], x[2], near * atom->radius[i]) : 0;
  for (int n = 0; n < faces; ++n) {
    const Region::Contact &face = region_->contact[n];
    near_.at(static_cast<std::size_t>(face.iwall)) = true;
    touch(face.iwall, physics::Vec3{face.delx / face.r, face.dely / face.r, face.delz / face.r}, face.r);
  }
  for (int place = 0; place < places_; ++place)
    if (!near_[static_cast<std::size_t>(place)]) std::fill_n(row(i, place), of_a_side, 0.0);
}

/// \param normal from the wall to the ball \param distance of its centre from the wall, m
template <bool stepped, FrictionModel tangential, bool rolling, class Table>
void FixWallGranTransition::touch(const Table &table, int i, int place, const physics::Vec3 &normal,
                                  double distance) {
  double *remembered = row(i, place);
  const bool touches = distance < atom->radius[i];
  if (!touches && remembered[0] == 0.0) return;
  const drumlin::ContactSettings &settings = pair_->contact_settings();
  const bool moves = update->setupflag == 0;
  const auto &law = table.at(atom->type[i], type_);
  using Parameters = std::decay_t<decltype(law.contact)>;
  const double mass = pair_->mass_unless_frozen(i);
  const double *v = atom->v[i];

  drumlin::WallContact p{};
  p.normal.i = i;
  p.normal.j = -1;
  p.normal.normal = normal;
  p.normal.overlap = atom->radius[i] - distance;
  p.normal.rate_half = -(v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2]);
  p.normal.m_eff = mass;
  p.normal.share = 1.0;
  p.r_eff = drumlin::radius_for<Parameters>(atom->radius[i]);
  p.history = remembered + 1;
  p.places = &places_of_side_;
  if constexpr (Parameters::remembers) p.memory = *p.stored(drumlin::Remembered::memory);
  p.in_contact = remembered[0] != 0.0;

  drumlin::ContactForces forces{};
  const std::size_t announced = stepped ? stepping_->announced() : 0;
  if (!touches) { // it did, a step ago
    if constexpr (stepped)
      forces.force =
          physics::scaled(drumlin::end_contact(law.contact.law(p.normal.m_eff, p.r_eff, p.memory), *stepping_,
                                               p.normal, *p.stored(drumlin::Remembered::force)),
                          normal);
    std::fill_n(remembered, of_a_side, 0.0);
  } else {
    remembered[0] = 1.0;
    p.arm_i = atom->radius[i] - 0.5 * p.normal.overlap; // as between balls
    if constexpr (tangential != FrictionModel::none) {
      const double *w = atom->omega[i];
      p.slip = physics::slip_velocity({v[0], v[1], v[2]}, normal,
                                      {p.arm_i * w[0], p.arm_i * w[1], p.arm_i * w[2]});
    }
    forces = drumlin::exert<stepped, tangential, rolling>(settings, law, stepping_, p, update->dt, moves);
    if constexpr (rolling) {
      const double *w = atom->omega[i];
      forces.rolling = drumlin::rolling_torque(
          law, {normal, {w[0], w[1], w[2]}, atom->radius[i]}, forces.tangential_stiffness,
          forces.normal_force, p.stored(drumlin::Remembered::rolling_spring),
          drumlin::time_of_spring(p, update->dt, moves), forces.rubbing());
    }
    if (observers_.any())
      observers_.tell(drumlin::record_of(settings, law, p, forces, atom->radius[i], atom->radius[i]));
    if constexpr (stepped && (tangential != FrictionModel::none || rolling))
      if (forces.begun != nullptr) {
        const FixStepping::RubbingForces closing = stepping_->close_friction(*forces.begun);
        forces.force = physics::sum(closing.friction, forces.begun->step.kick, normal);
        forces.moment = physics::cross(normal, closing.friction);
        forces.rolling = closing.rolling;
      }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    atom->f[i][a] += forces.force[a];
    atom->torque[i][a] += forces.rolling[a] - p.arm_i * forces.moment[a];
  }
  force_ = physics::sum(force_, 1.0, forces.force);
  if constexpr (stepped) { // half of what acts in the closing half kick, half of what acts in the next
                           // opening one
    force_ = physics::sum(force_, 0.5, stepping_->rest_since(announced));
    if (forces.coupled != nullptr)
      forces.coupled->report = [this](const physics::Vec3 &change) {
        force_ = physics::sum(force_, 1.0, change);
      };
  }
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
