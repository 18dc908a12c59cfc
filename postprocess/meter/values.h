// What a roller's meter shows: compaction meter values, stiffness, modulus, energy and operating mode over
// windows of whole cycles of a record.
//
// Sources. CMV: Advances in Civil Engineering 2011, 783836. Operating modes: Adam 1996, as in Acta
// Geotechnica 2024, 10.1007/s11440-024-02342-8. k_B and the ratio of soil force and displacement: the
// equations of motion of the paper. Lundberg's deflection of an elastic half-space below a cylinder: see
// lundberg_deflection().
#pragma once

#include "meter/cycles.h"
#include "support/statistics.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace drumlin::post {

/// Operating modes after Adam, as far as one vertical signal shows them: rocking, in which the two ends of
/// the drum differ, is not seen.
enum class OperatingMode {
  continuous_contact, ///< contact in every sample
  partial_uplift,     ///< the same motion in every cycle, with loss of contact
  double_jump,        ///< the same motion every second cycle
  irregular,          ///< neither: chaos, a longer period, or a motion that is not steady yet
  same_each_cycle ///< the same motion in every cycle, contact not known: no force, or the drum just touches
};
constexpr std::size_t mode_count = 5;
/// As they stand in files and tables: "continuous contact", "partial uplift", "double jump", "irregular",
/// "same in each cycle".
extern const std::array<const char *, mode_count> mode_names;

/// Poisson's ratio of soil where none is given [-].
constexpr double usual_poisson = 0.35;

struct MeterOptions {
  int window = 10;                          ///< cycles in a window, even, 4 or more
  double rmv_constant = usual_rmv_constant; ///< 100, or 300 in some sources
  double same = 0.05;                       ///< relative difference up to which cycles count as the same [-]
  std::optional<double> drum_radius;        ///< R [m]
  std::optional<double> drum_width;         ///< L [m]
  double poisson = usual_poisson;           ///< nu of the soil, for E_vib [-]
};

/// Values over one window. What the record does not give has no value.
struct MeterWindow {
  std::size_t first = 0;                               ///< first cycle, counted from 0
  double begin = 0.0;                                  ///< [s]
  double end = 0.0;                                    ///< [s]
  std::array<double, meter_orders.size()> amplitude{}; ///< A_n [m/s2]; of every_step 0 at 1.5, 2.5 and 3
  std::optional<double> cmv;                           ///< 300 A_2 / A_1 [-]
  std::optional<double> rmv;                           ///< constant A_0.5 / A_1 [-]
  std::optional<double> ccv; ///< 100 (A_0.5 + A_1.5 + A_2 + A_2.5 + A_3) / (A_0.5 + A_1) [-]
  /// Largest error of each of these values that sampling and noise can cause [-], see sampling_bound(); 0 if
  /// the sums contain every time step.
  double cmv_bound = 0.0, rmv_bound = 0.0, ccv_bound = 0.0;
  std::optional<double> displacement;  ///< amplitude A_1 / omega^2 of the drum's first harmonic [m]
  std::optional<double> contact_share; ///< [-]
  std::optional<double> peak_force;    ///< [N]
  std::optional<double> energy; ///< given to the soil in two cycles, the quantity behind the Omega value [J]
  /// k_B = omega^2 (m_d + m_e r_e cos(phi) / A_z) [N/m], phi the angle by which the displacement lags the
  /// eccentric force, A_z its amplitude, m_d the mass of the drum alone. In continuous contact: the stiffness
  /// of the soil plus what the frame on its bond adds, real part of its force over the displacement. Apparent
  /// in other modes. None if it is not above zero, as k_1 and c_1 are none if one of them is below.
  std::optional<double> k_B;
  /// The same with the frame's force: soil force over displacement at the excitation frequency, real part of
  /// -F/x [N/m] and imaginary part over omega [N s/m]. In continuous contact these are exactly the stiffness
  /// and damping of a linear soil; apparent in other modes.
  std::optional<double> k_1;
  std::optional<double> c_1;
  std::optional<double> E_vib; ///< Lundberg's modulus, mean over the cycles that give it [Pa]
  OperatingMode mode = OperatingMode::irregular;
  std::optional<double> from, to; ///< places of a roller that drives, at begin and end [m]
  int pass = 0;                   ///< its pass at the beginning, counted from 1
};

/// Windows of whole cycles one after the other; the last one ends with the record's last whole cycle, and
/// cycles before the first window are left out. std::runtime_error "the window is '...'; allowed: ..." if the
/// record has fewer cycles.
std::vector<MeterWindow> meter_windows(const MeterRecord &record, const MeterOptions &options);

/// A drum on an elastic half-space.
struct LineContact {
  double radius = 0.0;  ///< R of the drum [m]
  double length = 0.0;  ///< L, width of the drum [m]
  double poisson = 0.0; ///< nu of the soil [-]
};

/// Deflection [m] below a force [N] for a modulus E [Pa], after Lundberg:
///     z = (1 - nu^2)/E F/L 2/pi (1.8864 + ln(L/B)),  B = sqrt(16/pi R (1 - nu^2)/E F/L) the full contact
///     width,
/// valid for a contact longer than wide. Checked in the tests by integration over the half-space.
double lundberg_deflection(double force, double modulus, const LineContact &contact);

/// The modulus [Pa] for which lundberg_deflection() is `deflection`; no value if force or deflection is not
/// above zero, or if the contact would be wider than long.
std::optional<double> lundberg_modulus(double force, double deflection, const LineContact &contact);

} // namespace drumlin::post
