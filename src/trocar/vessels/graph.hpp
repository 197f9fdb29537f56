// A vessel graph as somebody describes it: segments between nodes, what feeds them (heart, pump, collaterals, veins)
// and what their far ends give way to; and the check that finds everything unsound in it, all faults in one pass.
//
//   VesselGraph graph;
//   graph.nodes = 2;
//   graph.segments = {{.from = 0, .to = 1, .length = 0.12, .radius = 0.8e-3, .wall = {.modulus = 1e6,
//                      .thickness = 0.15e-3}}};
//   graph.sources = {{.node = 0, .kind = VesselSource::Kind::heart}};
//   graph.ends = {matched_end(graph, 0, 12000, 1e-6, 1.0)};
//   for (const GraphFault& fault : check(graph)) ...  // a reader adds path:line:col from (part, index, field)
//   const FlowModel model = build(graph);             // flow.hpp
//
// Cycles (anastomoses) are allowed unless `tree` asks for none; so are several segments between the same two nodes and
// parts that are not connected with each other (arteries and veins), as long as each has a source.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/vessels/heart.hpp>

namespace trocar::vessels {

inline constexpr double kPascalPerMmHg = 133.322;

/// What holds a vessel open: p - p_ref = B (sqrt(A / A_ref) - 1). B = E h / (r (1 - nu^2)), or 2 rho c^2 where the
/// wave speed c is given instead. nu = 0: the ring of Moens and Korteweg, c = sqrt(E h / 2 rho r); nu = 1/2: a wall
/// that cannot lengthen, as vessels in the body are held.
struct VesselWall {
  double modulus = 0;     ///< E [Pa]
  double thickness = 0;   ///< h [m]
  double poisson = 0;     ///< nu [-], 0 .. 0.5
  double wave_speed = 0;  ///< c at the reference pressure [m/s]; > 0: used instead of the three above
};

struct VesselSegment {
  int from = -1, to = -1;                           ///< nodes; s runs 0 .. 1 from one to the other
  double length = 0;                                ///< [m]
  double radius = 0;                                ///< of the lumen at `from`, at the reference pressure [m]
  double radius_to = 0;                             ///< at `to` [m]; 0 = the same
  VesselWall wall{};                                ///< of its middle
  double reference_pressure = 93 * kPascalPerMmHg;  ///< p_ref [Pa]
  double loss = 0;                                  ///< K: what turns and narrows cost beyond friction, K rho u^2 / 2
  bool vein = false;                                ///< openings ooze even below the pressure around them
};

/// Where a node's blood goes when the graph ends there: r_near, then a compliance beside r_far to veins at `pressure`.
/// No end at a node without further segments: closed, reflects.
struct VesselEnd {
  int node = -1;
  double r_near = 0;                     ///< [Pa s/m^3]
  double r_far = 0;                      ///< [Pa s/m^3]; r_near + r_far > 0
  double compliance = 0;                 ///< [m^3/Pa]; 0 = none
  double pressure = 5 * kPascalPerMmHg;  ///< beyond it [Pa]
};

/// What feeds the graph. The clip rule counts every one of them as a source of pressure.
struct VesselSource {
  enum class Kind {
    heart,   ///< the heart's pressure (heart.hpp)
    steady,  ///< a constant pressure: a bed of collaterals, a vein's far end; breathing moves it where `venous`
    pump,    ///< a prescribed inflow, `wave` [m^3/s] over a beat
  };
  int node = -1;
  Kind kind = Kind::heart;
  double pressure = 0;         ///< steady: [Pa]
  double resistance = 0;       ///< between it and its node [Pa s/m^3]; 0 = next to none
  bool venous = false;         ///< breathes with the veins; does not fall with loss
  std::vector<double> wave{};  ///< pump: equal steps over one beat, the first follows the last; >= 2 figures
};

struct Blood {
  double density = 1060;      ///< [kg/m^3]
  double viscosity = 3.5e-3;  ///< [Pa s]
  double profile = 2;         ///< exponent of the velocity profile: friction 2 (profile + 2) pi mu u; 2 = Poiseuille's
  double volume = 5e-3;       ///< of the patient [m^3]; a loss counts by its share of it

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("density", s.density), v("viscosity", s.viscosity), v("profile", s.profile),
        v("volume", s.volume, core::kNotHashed);
  }
};

/// How the model is cut into cells and what its openings do; defaults are our choice unless said.
struct FlowSettings {
  double tick = core::kTick;     ///< [s]
  double implicitness = 0.55;    ///< 1/2 = second order and undamped; above it fast ringing dies: (1/2, 1]
  double cell_travel = 2;        ///< longest cell, in distances that a wave travels in a tick
  double closing_cover = 0.98;   ///< a clip of at least this cover closes; as of lumen.hpp
  double discharge = 0.61;       ///< Cd of openings (sharp-edged hole, textbooks)
  double drain_time = 0.25;      ///< an opening cut off from all sources runs dry, at the latest after this [s]
  double ooze_speed = 5e-3;      ///< out of a vein at the pressure around it; nothing 15 mmHg below it [m/s]
  double clot_area = 0.8e-6;     ///< openings below this area [m^2] clot
  double clot_time_small = 180;  ///< the smallest in this time [s], [literature: 180 .. 300 s]
  double clot_time_large = 300;  ///< those of nearly clot_area in this [s]
  double cavity_pressure = 12 * kPascalPerMmHg;  ///< that a partial clip's resistance is figured with [Pa]
  int max_openings = 64, max_clips = 64;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("tick", s.tick), v("implicitness", s.implicitness), v("closing_cover", s.closing_cover),
        v("discharge", s.discharge), v("drain_time", s.drain_time), v("ooze_speed", s.ooze_speed),
        v("clot_area", s.clot_area), v("clot_time_small", s.clot_time_small), v("clot_time_large", s.clot_time_large),
        v("max_openings", s.max_openings), v("max_clips", s.max_clips),
        v("cell_travel", s.cell_travel, core::kNotHashed), v("cavity_pressure", s.cavity_pressure, core::kNotHashed);
  }
};

struct VesselGraph {
  int nodes = 0;
  std::vector<VesselSegment> segments;
  std::vector<VesselEnd> ends;
  std::vector<VesselSource> sources;
  Heart heart;
  Blood blood;
  FlowSettings settings;
  bool tree = false;  ///< refuse cycles
};

inline constexpr std::size_t kMaxSegments = 20'000;
inline constexpr std::size_t kMaxCells = 200'000;

/// Something unsound: which entry of which array (or none of them: index -1), which of its fields, and in the manner
/// of all faults what was expected and what stands there. (A node that no segment names is a fault of `nodes` with the
/// node as index.)
struct GraphFault {
  enum class Part { graph, segment, end, source, heart, blood, settings };
  Part part = Part::graph;
  int index = -1;
  std::string field;
  std::string message;
};

/// All faults, in the order of the arrays; empty = sound. At most 100 are reported, then the number of the others.
std::vector<GraphFault> check(const VesselGraph& graph);

/// B of a segment's wall [Pa], and its wave speed at the reference pressure [m/s].
double wall_stiffness(const VesselSegment& segment, const Blood& blood);
double wave_speed(const VesselSegment& segment, const Blood& blood);
/// Poiseuille's 8 mu L / pi r^4 (by the blood's profile) [Pa s/m^3], over a taper too.
double flow_resistance(const VesselSegment& segment, const Blood& blood);

/// An end for the `to` node of a segment that lets a mean flow through at a mean pressure and reflects no waves:
/// r_near = rho c / A, r_far the rest, compliance = time / r_far.
VesselEnd matched_end(const VesselGraph& graph, int segment, double pressure, double flow, double time);

}  // namespace trocar::vessels
