// A body small enough to be stepped thousands of times in a test: an organ, a tube that grows out of it, a cord that
// must not be cut, a soft pad below, a bar that can be cut through, a floor, and three instruments straight above.
// Drawn in round numbers, so that what the step should find can be worked out by hand.
//
//   const sim::Model& model = small::model();
//   small::Hands hands(model);                 // grasps, lifts, clips twice, cuts the tube, then the bar
//   while (!hands.done()) step(model, hands.next(state), state, work);
#pragma once

#include <numbers>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::small {

inline constexpr int kGrasper = 0, kScissors = 1, kApplier = 2;
inline constexpr int kTube = 0, kCord = 1;
inline constexpr int kBar = 2;          ///< among the organs
inline constexpr double kBarY = 0.045;  ///< [m]
inline constexpr double kTubeRadius = 0.0016;
inline constexpr double kHeight = 0.10;  ///< of the ports above the tube, which lies along x at y = z = 0 [m]

inline scene::Tissue tissue(const char* name, double young) {
  scene::Tissue t;
  t.name = name;
  t.young = young;
  t.p1 = 3;
  t.p2 = 30;
  t.strain_cap = 0.2;
  return t;
}

inline scene::Solid organ() {
  scene::Solid s;
  s.name = "organ";
  s.tissue = "flesh";
  for (double x : {-0.034, -0.026, -0.018, -0.010}) s.sections.push_back({{x, 0, 0}, {0, 0.016, 0}, {0, 0, 0.012}, 2});
  s.cell = 0.005;
  s.skin_edge = 0.004;
  s.fine_edge = 0.003;
  s.anchors.push_back({{-0.042, 0, 0}, 0.014, 0, {}});
  return s;
}

/// Lies 0.5 mm below the tube, 12 mm thick, on springs.
inline scene::Solid pad() {
  scene::Solid s;
  s.name = "pad";
  s.tissue = "flesh";
  for (double x : {0.040, 0.050, 0.060}) s.sections.push_back({{x, 0, -0.0081}, {0, 0.014, 0}, {0, 0, 0.006}, 2});
  s.cell = 0.004;
  s.skin_edge = 0.004;
  s.fine_edge = 0.003;
  s.anchors.push_back({{0.050, 0, -0.0141}, 0.012, 200, {}});
  return s;
}

/// A bar that can be cut through, held at one end.
inline scene::Solid bar() {
  scene::Solid s;
  s.name = "bar";
  s.tissue = "duct";
  for (double x : {-0.004, 0.011, 0.026, 0.041}) s.sections.push_back({{x, kBarY, 0}, {0, 0.003, 0}, {0, 0, 0.004}, 2});
  s.cell = 0.004;
  s.cuttable = true;
  s.anchors.push_back({{-0.006, kBarY, 0}, 0.018, 0, {}});
  return s;
}

inline scene::Strand tube() {
  scene::Strand s;
  s.name = "tube";
  s.tissue = "duct";
  for (double x : {-0.001, 0.020, 0.040, 0.060, 0.080}) s.centreline.push_back({x, 0, 0});
  s.stations = {{0, kTubeRadius, 0.0005}};
  s.landmarks = {{"isthmus", 0, 0.035}, {"ampulla", 0.035, 0.081}};
  s.start.organ = "organ";
  s.foundation = 800;
  s.foundation_limit = 0.035;
  return s;
}

/// Beside the tube, fixed at both ends, spared by scissors.
inline scene::Strand cord() {
  scene::Strand s;
  s.name = "cord";
  s.tissue = "duct";
  for (double x : {0.0, 0.025, 0.050, 0.075}) s.centreline.push_back({x, 0.020, 0});
  s.stations = {{0, 0.002, 0}};
  s.start.fixed = s.end.fixed = true;
  s.foundation = 600;
  s.cuttable = false;
  return s;
}

/// A fold below the tube's first part; its base rides on the organ where that is near.
inline scene::Membrane fold() {
  scene::Membrane m;
  m.name = "fold";
  m.tissue = "web";
  m.strand = "tube";
  m.from = 0.005;
  m.to = 0.031;
  m.base = {{0.004, 0.001, -0.012}, {0.017, 0.002, -0.014}, {0.030, 0, -0.014}};
  m.base_on = {"organ"};
  m.thickness = 0.0005;
  return m;
}

inline scene::Instrument instrument(const char* name, interactions::ToolKind kind) {
  scene::Instrument i;
  i.name = name;
  i.kind = kind;
  return i;
}

/// An artery from a node to another, straight or through a point between.
inline void add_artery(scene::VesselTree& tree, const char* name, int from, int to, std::vector<Vec3d> path,
                       std::vector<std::string> rides_on, double radius = 0.0006) {
  scene::Vessel v;
  v.name = name;
  v.path = std::move(path);
  v.rides_on = std::move(rides_on);
  v.rides_at.resize(v.rides_on.size());
  vessels::VesselSegment s;
  s.from = from;
  s.to = to;
  for (size_t i = 1; i < v.path.size(); ++i) s.length += length(v.path[i] - v.path[i - 1]);
  s.radius = radius;
  s.wall.wave_speed = 9;
  tree.graph.segments.push_back(s);
  tree.vessels.push_back(std::move(v));
}
inline constexpr int kTubesEnd = 3;  ///< a node
inline constexpr int kTubeArtery = 0, kFoldArtery = 1, kBarArtery = 2;

/// One in the tube, one in the fold beside it, one through the bar; each begins at the heart.
inline scene::VesselTree arteries() {
  scene::VesselTree tree;
  tree.name = "arteries";
  tree.nodes = {"tubes_heart", "folds_heart", "bars_heart", "tubes_end", "folds_end", "bars_end"};
  tree.graph.nodes = 6;
  add_artery(tree, "tube_artery", 0, kTubesEnd, {{0.001, 0, 0}, {0.040, 0, 0}, {0.078, 0, 0}}, {"tube"});
  add_artery(tree, "fold_artery", 1, 4, {{0.007, 0, -0.0045}, {0.018, 0, -0.005}, {0.029, 0, -0.0045}}, {"fold"},
             0.0004);
  add_artery(tree, "bar_artery", 2, 5, {{-0.002, kBarY, 0}, {0.020, kBarY, 0.0005}, {0.040, kBarY, 0}}, {"bar"});
  for (int i = 0; i < 3; ++i) {
    tree.graph.ends.push_back(vessels::matched_end(tree.graph, i, 88 * vessels::kPascalPerMmHg, 10e-6 / 60, 1));
    tree.graph.sources.push_back({.node = i});
  }
  return tree;
}

inline scene::Description description() {
  scene::Description d;
  d.name = d.title = "small";
  d.tissues = {tissue("flesh", 20e3), tissue("duct", 60e3), tissue("web", 10e3)};
  d.solids = {organ(), pad(), bar()};
  d.strands = {tube(), cord()};
  d.membranes = {fold()};
  d.vessels = {arteries()};
  d.fluids = scene::FluidsSetting{{0.025, 0, -0.019}, 0.14, {}, 1024, 0, 0, {}};
  scene::Wall floor;
  floor.name = "floor";
  floor.rows = floor.columns = 3;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) floor.net.push_back({-0.05 + 0.075 * c, 0.05 - 0.05 * r, -0.020});
  d.walls = {floor};
  d.ports = {{"a", {0.055, 0, kHeight}, 0.005, {}},
             {"b", {0.026, 0.03, kHeight}, 0.005, {}},
             {"c", {0.026, -0.03, kHeight}, 0.010, {}},
             {"eye", {0.03, 0.06, 0.08}, 0.010, {}}};
  scene::Instrument grasper = instrument("grasper", interactions::ToolKind::grasper);
  grasper.jaw_length = 0.022;
  grasper.jaw_width = 0.004;
  grasper.jaw_thickness = 0.0018;
  grasper.opening = 1.05;
  scene::Instrument scissors = instrument("scissors", interactions::ToolKind::scissors);
  scissors.jaw_length = 0.015;
  scissors.jaw_width = 0.0025;
  scissors.jaw_thickness = 0.0012;
  scissors.opening = 0.8;
  scene::Instrument applier = instrument("clip_applier", interactions::ToolKind::clip_applier);
  applier.shaft_radius = 0.005;
  applier.jaw_length = 0.018;
  applier.jaw_width = 0.0045;
  applier.jaw_thickness = 0.002;
  applier.opening = 0;
  applier.parallel_gap = 0.006;
  applier.clips = 20;
  d.instruments = {grasper, scissors, applier};
  // A quarter turn: the jaws open along y, across the tube.
  const double across = 1.57079632679489662;
  d.placements = {{"grasper", "a", {0.055, 0, 0.04}, across, {}},
                  {"scissors", "b", {0.026, 0.02, 0.05}, across, {}},
                  {"clip_applier", "c", {0.026, -0.02, 0.05}, across, {}}};
  d.scope_placement = {"", "eye", {0.03, 0.05, 0.055}, 0, {}};
  return d;
}

inline const sim::Model& model() {
  static const sim::Model compiled = scene::compile(description());
  return compiled;
}

/// The same without the fold.
inline const sim::Model& bare() {
  static const sim::Model compiled = [] {
    scene::Description d = description();
    d.membranes.clear();
    d.vessels.clear();
    d.fluids.reset();
    return scene::compile(d);
  }();
  return compiled;
}

/// The same with organs that answer at once: the organ held rigidly, the pad on springs, and the bar, which hands
/// itself over when it is cut.
inline scene::Description static_description() {
  scene::Description d = description();
  for (scene::Solid& s : d.solids) s.solver = scene::Solver::elastostatic;
  return d;
}
inline const sim::Model& statics() {
  static const sim::Model compiled = scene::compile(static_description());
  return compiled;
}

/// Hands that do the whole work in six seconds, faster than anybody should: they look at the State like a surgeon.
class Hands {
 public:
  explicit Hands(const sim::Model& model) : m_model(model), m_input(model.start) {
    for (size_t t = 0; t < model.hands.size(); ++t)
      m_tip[t] = kinematics::forward(model.hands[t].port, pose_of(model.start.tools[t])).tip;
  }

  /// Where it clips and cuts the tube [m]; below 0: not at all.
  double first_clip = 0.016, second_clip = 0.026, cut_at = 0.021;

  bool done() const { return m_at >= kTicks; }
  static constexpr int kTicks = 5800;

  sim::Input next(const sim::State& s) {
    const int t = m_at++;
    if (t < 300) aim(s, kGrasper, 0.056, 0.012);
    if (t >= 300 && t < 700) handle(kGrasper, 0.95, 300);
    if (t >= 700 && t < 1100) m_tip[kGrasper] += Vec3d{0, 0, 0.008 / 400};
    clip(s, t - 1100, first_clip);
    clip(s, t - 2300, second_clip);
    cut(s, t - 3500, cut_at);
    cut_bar(t - 4400);
    for (size_t i = 0; i < m_model.hands.size(); ++i) {
      const kinematics::FulcrumPose pose = kinematics::inverse(m_model.hands[i].port, m_tip[i], roll(s, i));
      m_input.tools[i] = sim::tool_input(pose, float(m_handle[i]));
    }
    return m_input;
  }

 private:
  void move(int tool, Vec3d to) {
    const Vec3d way = to - m_tip[size_t(tool)];
    const double far = length(way), most = 0.25 * sim::kTick;
    m_tip[size_t(tool)] += (far <= most ? 1.0 : most / far) * way;
  }
  /// The tube at arc length s comes to lie `inside` from the hinge.
  void aim(const sim::State& state, int tool, double s, double inside) {
    const interactions::StrandBody& body = m_model.strand_bodies[kTube];
    const interactions::ToolModel& t = m_model.placed(size_t(tool));
    const Vec3d at = interactions::point_at(body, state.strands[kTube], interactions::place_at(body, s));
    move(tool, at + (t.jaw_length - inside) * normalised(at - t.port));
  }
  void handle(int tool, double to, int ticks) {
    double& h = m_handle[size_t(tool)];
    h += std::clamp(to - h, -1.0 / ticks, 1.0 / ticks);
  }
  double roll(const sim::State& state, size_t tool) {
    const interactions::StrandBody& body = m_model.strand_bodies[kTube];
    const double s = tool == size_t(kGrasper) ? 0.056 : 0.021;
    const bool at_bar = tool == size_t(kScissors) && m_at > 4400;
    const Vec3d along =
        at_bar ? Vec3d{1, 0, 0} : tangent_at(body, state.strands[kTube], interactions::place_at(body, s));
    const kinematics::FulcrumPose pose = kinematics::inverse(m_model.hands[tool].port, m_tip[tool], 0);
    double wanted = kinematics::roll_towards(pose, along);
    const double half = std::numbers::pi, now = double(m_input.tools[tool].roll);
    while (wanted - now > 0.5 * half) wanted -= half;
    while (wanted - now < -0.5 * half) wanted += half;
    return now + std::clamp(wanted - now, -0.004, 0.004);
  }
  void clip(const sim::State& s, int t, double arc) {
    if (t < 0 || t >= 1200 || arc < 0) return;
    if (t < 900) aim(s, kApplier, arc, 0.013);
    if (t >= 400 && t < 800) handle(kApplier, 1, 350);
    if (t >= 800) handle(kApplier, 0, 250);
    if (t >= 900) move(kApplier, {0.026, -0.02, 0.05});
  }
  void cut(const sim::State& s, int t, double arc) {
    if (t < 0 || arc < 0) return;
    if (t < 700) aim(s, kScissors, arc, 0.010);
    if (t >= 350 && t < 600) handle(kScissors, 1, 200);
    if (t >= 600 && t < 900) handle(kScissors, 0, 200);
    if (t >= 700 && t < 900) move(kScissors, {0.026, 0.02, 0.05});
  }

  /// Down over the bar with open blades, until its middle is well between them.
  void cut_bar(int t) {
    if (t < 0) return;
    const double inside = 0.010, down = m_model.placed(kScissors).jaw_length - inside;
    if (t < 300) move(kScissors, {0.026, kBarY, 0.030});
    if (t >= 300 && t < 600) move(kScissors, {0.026, kBarY, -down});
    if (t >= 600 && t < 800) handle(kScissors, 1, 150);
    if (t >= 800) handle(kScissors, 0, 150);
    if (t >= 950) move(kScissors, {0.026, kBarY, 0.040});
  }

  const sim::Model& m_model;
  sim::Input m_input;
  std::array<Vec3d, sim::kMaxTools> m_tip{};
  std::array<double, sim::kMaxTools> m_handle{};
  int m_at = 0;
};

/// A State and hands that go where a test says.
struct Table {
  const sim::Model& model;
  sim::State state;
  sim::Work work;
  sim::Input input;
  std::uint32_t flags = 0;
  std::vector<sim::Event> events;

  explicit Table(const sim::Model& m)
      : model(m), state(sim::initial_state(m)), work(sim::make_work(m)), input(m.start) {}

  void step() {
    const sim::StepReport report = sim::step(model, input, state, work);
    flags |= report.flags;
    events.insert(events.end(), report.events, report.events + report.event_count);
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
  /// Where the tip shall be; the roll stays.
  void point(int tool, Vec3d tip) {
    sim::ToolInput& in = input.tools[size_t(tool)];
    in = sim::tool_input(kinematics::inverse(model.hands[size_t(tool)].port, tip, double(in.roll)), in.handle);
  }
  void close(int tool, double handle) { input.tools[size_t(tool)].handle = float(handle); }
  /// Closes or opens within `ticks`.
  void close_slowly(int tool, double handle, int ticks) {
    const double from = double(input.tools[size_t(tool)].handle);
    for (int i = 1; i <= ticks; ++i) {
      close(tool, from + (handle - from) * i / ticks);
      step();
    }
  }
  /// Moves the tip there in a straight line, at `speed` [m/s].
  void carry(int tool, Vec3d from, Vec3d to, double speed) {
    const int n = int(length(to - from) / (speed * sim::kTick)) + 1;
    for (int i = 1; i <= n; ++i) {
      point(tool, from + double(i) / n * (to - from));
      step();
    }
  }
  int count(sim::Event::Kind kind) const {
    int n = 0;
    for (const sim::Event& e : events) n += e.kind == kind;
    return n;
  }
  const interactions::ToolState& tool(int t) const { return state.tools[size_t(t)]; }
  Vec3d pull(int t) const { return {tool(t).pull[0], tool(t).pull[1], tool(t).pull[2]}; }
};

}  // namespace trocar::small
