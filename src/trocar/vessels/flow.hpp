// Blood in a vessel graph, one tick at a time: pulse waves with reflections and friction in walls that give, ends that
// take it up, openings it leaves by, clips that stop it. One-dimensional flow [Hughes & Lubliner 1973, Formaggia 2003]:
//
//   A_t + Q_x = 0                       A: lumen [m^2], Q: flow from `from` to `to` [m^3/s], p: static pressure [Pa]
//   Q_t + (Q^2 / A)_x + A p_x / rho = - 2 (profile + 2) pi (mu / rho) Q / A
//   p - p_ref = B (sqrt(A / A_ref) - 1)
//
// on cells between rows of pressures: flow in the middle of a cell, pressure at its ends, pressure the same in all that
// meet at a node. Second order in both, one implicit step a tick, solved exactly by elimination (elimination.hpp):
// stable whatever a wave travels in a tick, so segments shorter than that are simply a cell each.
//
//   FlowModel model = build(graph);
//   FlowState state = settled_state(model, 10);  // seconds of heartbeat before the first tick
//   FlowWork work = make_work(model);
//   FlowReport report = advance(model, {.openings = openings, .clips = clips}, flows, state, work);
//   // flows[k].picolitres[side]: what left through opening k in this tick, to be booked as it is
//
// Clip rule: an opening has no flow, exactly, if and only if no way leads from any source to it that meets neither a
// closed clip nor a cut (and it is neither clotted nor sealed, and the pressure inside is above that outside). What is
// cut off that way first runs dry by what its walls still hold, for `drain_time` at most; then nothing moves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/vessels/elimination.hpp>
#include <trocar/vessels/graph.hpp>

namespace trocar::vessels {

/// A piece of a segment between two rows: what its terms need, per unit of what changes.
struct FlowCell {
  int a = 0, b = 0;               ///< rows at its ends
  double rest = 0, give = 0;      ///< sqrt(A / A_ref) = rest + give p
  double area_a = 0, area_b = 0;  ///< A_ref at its ends [m^2]
  double area = 0;                ///< and in its middle
  double inertia = 0;             ///< rho dx / (theta dt) [kg/m^2 s]
  double friction = 0;            ///< 2 (profile + 2) pi mu dx [Pa m s]
  double loss = 0;                ///< K rho / 2 of this cell's share [kg/m^3]
  double carried = 0;             ///< 2 rho dx A_ref give / dt: what the flow carries along [kg/m^2 s .. /Pa]
  double courant = 0;             ///< dt / dx [s/m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("a", s.a), v("b", s.b), v("rest", s.rest), v("give", s.give), v("area_a", s.area_a), v("area_b", s.area_b),
        v("area", s.area), v("inertia", s.inertia), v("friction", s.friction), v("loss", s.loss),
        v("carried", s.carried), v("courant", s.courant);
  }
};

struct FlowSegment {
  int from = 0, to = 0;          ///< nodes of the graph
  int first = 0, cells = 0;      ///< its cells, in order from `from` to `to`
  double length = 0;             ///< [m]
  double radius = 0, taper = 0;  ///< radius + taper s at the reference pressure [m]
  double rest = 0, give = 0;     ///< as in its cells
  double reference = 0;          ///< p_ref [Pa]
  double cut_resistance = 0;     ///< pressure over flow of this segment cut through, what a partial clip is measured by
  bool vein = false;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("from", s.from), v("to", s.to), v("first", s.first), v("cells", s.cells), v("vein", s.vein),
        v("length", s.length), v("radius", s.radius), v("taper", s.taper), v("rest", s.rest), v("give", s.give),
        v("reference", s.reference), v("cut_resistance", s.cut_resistance);
  }
};

struct FlowEnd {
  int row = 0;
  double near = 0;         ///< 1 / r_near [m^3/Pa s]
  double inner = 0;        ///< 1 / (C / dt + theta (1 / r_near + 1 / r_far)); 0: no compliance
  double far = 0;          ///< 1 / r_far
  double pressure = 0;     ///< [Pa]
  double conductance = 0;  ///< of all of it within a tick: flow per pressure at the row
  double storage = 0;      ///< C / dt

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("row", s.row), v("near", s.near), v("inner", s.inner), v("far", s.far), v("pressure", s.pressure),
        v("conductance", s.conductance), v("storage", s.storage);
  }
};

struct FlowSource {
  int node = 0, row = 0;
  VesselSource::Kind kind = VesselSource::Kind::heart;
  bool venous = false;
  double pressure = 0, conductance = 0;
  std::vector<double> wave;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("row", s.row), v("kind", s.kind), v("venous", s.venous), v("pressure", s.pressure),
        v("conductance", s.conductance), v("wave", s.wave), v("node", s.node, core::kNotHashed);
  }
};

/// Const after build(), shared by any number of simulations.
struct FlowModel {
  int nodes = 0;
  std::vector<FlowSegment> segments;
  std::vector<FlowCell> cells;
  std::vector<double> give, give2;     ///< (rows) capacity dV/dp = give + 2 give2 p [m^3/Pa], between
  std::vector<double> low, high;       ///< (rows) these pressures [Pa]; straight on beyond them
  std::vector<double> start_pressure;  ///< (rows) of rest_state [Pa]
  Elimination plan;                    ///< its links are the cells
  std::vector<FlowEnd> ends;
  std::vector<FlowSource> sources;
  Heart heart;
  std::vector<double> beat;  ///< 0 .. 1 over a beat
  double beat_mean = 0;
  Blood blood;
  FlowSettings settings;
  int drain_ticks = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("nodes", s.nodes), v("segments", s.segments), v("cells", s.cells), v("give", s.give), v("give2", s.give2),
        v("low", s.low), v("high", s.high), v("start_pressure", s.start_pressure), v("plan", s.plan), v("beat", s.beat),
        v("heart.response", s.heart.response, core::kPartOfField), v("ends", s.ends), v("sources", s.sources),
        v("heart", s.heart), v("blood", s.blood), v("settings", s.settings),
        v("beat_mean", s.beat_mean, core::kNotHashed), v("drain_ticks", s.drain_ticks, core::kNotHashed);
  }
};

/// Something that blood gets out by. Index in the input's span = slot in State and in the outputs; a slot that is not
/// used has no area. A slot that changes its segment or kind starts again (clot, remainder).
struct Opening {
  enum class Kind : std::int32_t { hole, cut };
  int segment = -1;
  double s = 0;            ///< 0 .. 1 along the segment
  Kind kind = Kind::hole;  ///< a cut goes through: two stumps, nothing passes between them
  double area = 0;         ///< [m^2]; of a cut: of each stump (lumen_area() where nothing narrows it)
  double outside = 0;      ///< pressure there [Pa]
  double sealed = 0;       ///< share that coagulation or a finger keeps shut, 0 .. 1
};

/// A clip around a segment; on the same place as an opening it counts as nearer to `from`. Cover <= 0: not used.
struct Occlusion {
  int segment = -1;
  double s = 0;      ///< 0 .. 1 along the segment
  double cover = 0;  ///< enclosed share of the lumen's width
};

struct FlowInput {
  std::span<const Opening> openings;  ///< at most settings.max_openings
  std::span<const Occlusion> clips;   ///< at most settings.max_clips
  double infusion = 0;                ///< [m^3/s]
};

/// What one opening did in a tick. Side 0: the stump towards `from` (a hole has only this one), side 1: the other.
struct OpeningFlow {
  std::int64_t picolitres[2] = {0, 0};  ///< that left; what is less than one waits for the next tick
  double flow[2] = {0, 0};              ///< mean over the tick [m^3/s]
  double pressure[2] = {0, 0};          ///< just inside [Pa]
  double clot = 0;                      ///< share that has clotted
  bool fed[2] = {false, false};         ///< an open way leads here from a source
};

struct OpeningState {
  double at = 0;                             ///< place in the cell, 0 .. 1
  double before = 0;                         ///< flow in the piece of the cell before it [m^3/s]
  double clot = 0;                           ///< 0 .. 1
  double flow[2] = {0, 0};                   ///< of the last tick [m^3/s]
  double pressure[2] = {0, 0};               ///< just inside [Pa]
  double remainder[2] = {0, 0};              ///< not yet told [pL]
  std::int32_t segment = -1, cell = -1;      ///< -1: not in use
  std::int32_t kind = 0, ticks_cut_off = 0;  ///< side 0
  std::int32_t ticks_cut_off_other = 0, unused = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("before", s.before), v("clot", s.clot), v("flow", s.flow), v("pressure", s.pressure),
        v("remainder", s.remainder), v("segment", s.segment), v("cell", s.cell), v("kind", s.kind),
        v("ticks_cut_off", s.ticks_cut_off), v("ticks_cut_off_other", s.ticks_cut_off_other), v("unused", s.unused);
  }
};

struct ClipState {
  double at = 0, before = 0;
  std::int32_t cell = -1, closed = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("before", s.before), v("cell", s.cell), v("closed", s.closed);
  }
};

struct FlowState {
  std::vector<double> p, dp;           ///< (rows) pressure, and its change in the last tick [Pa]
  std::vector<double> owed;            ///< (rows) volume that linearising has misplaced, put right next tick [m^3]
  std::vector<double> q, dq;           ///< (cells) flow, and its change [m^3/s]
  std::vector<double> end_pressure;    ///< (ends) of the compliance [Pa]
  std::vector<OpeningState> openings;  ///< (max_openings)
  std::vector<ClipState> clips;        ///< (max_clips)
  double beat = 0, breath = 0;         ///< phases, 0 .. 1
  std::int64_t bled = 0, infused = 0;  ///< [pL] since the start
  double infusion_remainder = 0;       ///< [pL]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("p", s.p), v("dp", s.dp), v("owed", s.owed), v("q", s.q), v("dq", s.dq), v("end_pressure", s.end_pressure),
        v("openings", s.openings), v("clips", s.clips), v("beat", s.beat), v("breath", s.breath), v("bled", s.bled),
        v("infused", s.infused), v("infusion_remainder", s.infusion_remainder);
  }
};

/// Scratch. Sites are the openings and clips of this tick in the order of their places.
struct FlowSite {
  double at = 0;
  double orifice = 0;     ///< rho / (2 (Cd A)^2) [kg/m^7]
  double outside = 0;     ///< [Pa]
  double ooze = 0;        ///< flow while fed and the pressure inside is that outside [m^3/s]
  double resistance = 0;  ///< of a partial clip [Pa s/m^3]
  int segment = 0, cell = 0, index = 0, point = 0;
  enum class Kind : std::int32_t { clip, hole, cut } kind = Kind::clip;
  bool closed = false;  ///< a clip that lets nothing pass
  bool fed[2] = {false, false}, open[2] = {false, false};
};
struct FlowChain {
  int cell = 0, first_site = 0, sites = 0, first_point = 0, points = 0;
  double conductance_a = 0, conductance_b = 0;  ///< of what lies beyond its ends, as far as the next rows [m^3/Pa s]
};
/// A place within a cell with pressure P and no volume of its own: G, S to the next place: flow G (P - P_next) + S.
struct FlowPoint {
  double g = 0, s = 0;                       ///< towards the place BEFORE it
  double out = 0, out0 = 0;                  ///< flow out of the graph: out P + out0
  double fixed = 0, from_a = 0, from_b = 0;  ///< P = fixed + from_a P_a + from_b P_b
  double guess = 0;                          ///< flow out that the line goes through [m^3/s]
  double scratch[2] = {0, 0};
};
struct FlowWork {
  std::vector<double> capacity, extra;         ///< (rows) volume taken up = capacity dp - extra [m^3/Pa], [m^3]
  std::vector<double> ahead;                   ///< (rows) pressure expected in the middle of the tick
  std::vector<double> diagonal, x;             ///< (rows)
  std::vector<double> values;                  ///< (plan.values())
  std::vector<double> flow0;                   ///< (cells) mean flow, less what this tick's pressures change in it
  std::vector<double> flow_a, flow_b;          ///< (cells) and that
  std::vector<FlowSite> sites;                 ///< (max_openings + max_clips)
  std::vector<FlowChain> chains;               ///< (the same)
  std::vector<FlowPoint> points;               ///< (3 times that + 1)
  std::vector<std::int32_t> part;              ///< (nodes) connected part
  std::vector<std::int8_t> part_fed, blocked;  ///< (nodes), (segments)
  int site_count = 0, chain_count = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("capacity", s.capacity), v("extra", s.extra), v("ahead", s.ahead), v("diagonal", s.diagonal), v("x", s.x),
        v("values", s.values), v("flow0", s.flow0), v("flow_a", s.flow_a), v("flow_b", s.flow_b), v("sites", s.sites),
        v("chains", s.chains), v("points", s.points), v("part", s.part), v("part_fed", s.part_fed),
        v("blocked", s.blocked), v("site_count", s.site_count), v("chain_count", s.chain_count);
  }
};

struct FlowReport {
  enum Flag : std::uint32_t {
    kFine = 0,
    kBadOpening = 1,    ///< an opening names no segment or is not finite (left out), or there are too many
    kBadClip = 2,       ///< the same of a clip
    kNonFinite = 4,     ///< the pressures have no solution: they and flows were not advanced; restore a State
    kHighPressure = 8,  ///< somewhere beyond 0.1 MPa: a pump works against closed clips; open one
  };
  std::uint32_t flags = kFine;
  int first_bad = -1;         ///< slot of the opening or clip, else the row
  double heart_pressure = 0;  ///< at the end of the tick [Pa]
  double heart_rate = 0;      ///< [1/min]
  int solves = 1;             ///< how often the tick was solved: more than once where something opens or closes
  bool fine() const { return (flags & (kBadOpening | kBadClip | kNonFinite)) == 0; }
};

/// Compiles a graph. Throws std::invalid_argument with the first of check()'s faults, std::length_error if it has too
/// many cells or anastomoses.
FlowModel build(const VesselGraph& graph);
/// Nothing flows, pressure is the mean of what feeds each part.
FlowState rest_state(const FlowModel& model);
/// After `seconds` of heartbeat without openings and clips.
FlowState settled_state(const FlowModel& model, double seconds);
FlowWork make_work(const FlowModel& model);

/// One tick. @param flows one per opening of the input, or empty
FlowReport advance(const FlowModel& model, const FlowInput& input, std::span<OpeningFlow> flows, FlowState& state,
                   FlowWork& work) noexcept;

/// What a monitor shows of the patient: by the heart's figures and what has been lost, without breathing.
struct Vitals {
  double rate = 0;                               ///< [1/min]
  double systolic = 0, diastolic = 0, mean = 0;  ///< [Pa]
};
Vitals vitals(const FlowModel& model, const FlowState& state) noexcept;

/// What can be read at a place s of a segment. `gain` enlarges what hand and eye get: 1 is physical, and then the wall
/// of an artery of a millimetre moves by hundredths of one.
struct WallReading {
  double pressure = 0;  ///< [Pa]
  double radius = 0;    ///< physical [m]
  double shift = 0;     ///< of the wall outwards from its drawn radius, times gain [m]
  double push = 0;      ///< pressure above the reference pressure, times gain: force per area on what touches it [Pa]
  double flow = 0;      ///< [m^3/s]
};
WallReading read_wall(const FlowModel& model, const FlowState& state, int segment, double s, double gain = 1) noexcept;
/// The same of many, in the middle of every segment: nobody looks for openings and clips twice.
/// @param walls  out: (segments)  @param busy  scratch: (segments)
void read_middles(const FlowModel& model, const FlowState& state, std::span<WallReading> walls,
                  std::span<std::uint8_t> busy) noexcept;
/// Of the lumen, at the present pressure [m^2].
double lumen_area(const FlowModel& model, const FlowState& state, int segment, double s) noexcept;
double node_pressure(const FlowModel& model, const FlowState& state, int node) noexcept;

/// Volume that a row takes up between two pressures, by the wall law; for tests and reports [m^3].
double row_volume(const FlowModel& model, int row, double from, double to) noexcept;

void add_to_hash(core::Hasher& hasher, const FlowModel& model) noexcept;
void add_to_hash(core::Hasher& hasher, const FlowState& state) noexcept;

}  // namespace trocar::vessels
