// The analysis view: what tissue, instruments and blood do, as figures in colour instead of as an eye sees them. Any
// camera can look at it. Everything is worked out from a const State and its Model; nothing is guessed:
//   springs   every spring as a line, coloured by e/l, l being its rest length (of strands: what heat has left of it);
//             of bodies that can be cut the edges of their cells, against the shape as drawn. What is cut is gone
//   strain    surfaces coloured by the largest stretch in them: organs and folds against the shape as drawn, strands
//             (tubes, ligaments) against the rest lengths of their elements
//   forces    arrows of what instruments do to tissue, and of what trocars do to the abdominal wall
//   pressure  vessels coloured by the blood's pressure in them, also where they run below the peritoneum
//   solvers   an organ coloured by how far its other solver has it elsewhere, with that one's outline as wires; only
//             where a second simulation runs beside (ViewOptions::beside)
// Forces of contact are kept by the State as normal forces averaged over some ten ticks, and as one sum for each
// instrument with friction; forces between organs are Work and cannot be shown.
//
//   ViewOptions options;  options.analysis.strain = options.analysis.forces = true;
//   const Legend legend = legend_of(options.analysis);     // the window draws it beside
#pragma once

#include <string>
#include <vector>

#include <trocar/view/base/colour_scale.hpp>

namespace trocar::view {

struct AnalysisOptions {
  bool springs = false, strain = false, forces = false, pressure = false, solvers = false;
  double strain_range = 0.2;    ///< strain of the scale's ends [-]
  double force_length = 0.010;  ///< of an arrow [m/N]
  double pressure_most = 120;   ///< at the scale's end [mmHg]
  double apart_most = 0.002;    ///< distance of both solvers at the scale's end [m]

  bool on() const { return springs || strain || forces || pressure || solvers; }
  friend bool operator==(const AnalysisOptions&, const AnalysisOptions&) = default;
};

inline Colour colour_of_strain(const AnalysisOptions& o, double strain) {
  return colour_on(Scale::diverging, strain / o.strain_range);
}
/// @param pressure  [Pa]
Colour colour_of_pressure(const AnalysisOptions& o, double pressure);

/// @param distance  of both solvers [m]
inline Colour colour_of_distance(const AnalysisOptions& o, double distance) {
  return colour_on(Scale::sequential, distance / o.apart_most);
}
inline constexpr Colour kOtherSolver{0.90f, 0.30f, 0.05f};  ///< its wires: vermilion, which is on no sequential scale

/// An organ as another simulation has it, whose solver for it is another one.
struct OrganBeside {
  int organ = -1;
  std::vector<Vec3f> skin;     ///< (vertices of the drawn skin) [m]
  std::vector<Vec3f> outline;  ///< (vertices of the skin that is touched) [m]
};

/// What arrows say, told apart by lightness, too.
enum class ForceKind { grip, touch, trocar };
Colour colour_of(ForceKind kind);

/// What a picture's colours mean.
struct Legend {
  struct Bar {
    std::string title;               ///< with its unit
    std::vector<Colour> colours;     ///< from low to high
    std::vector<std::string> ticks;  ///< evenly spaced from low to high
  };
  struct Key {
    Colour colour;
    std::string text;
  };
  std::vector<Bar> bars;
  std::vector<Key> keys;
};
Legend legend_of(const AnalysisOptions& options);

}  // namespace trocar::view
