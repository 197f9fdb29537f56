#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <trocar/attempt/free_way.hpp>
#include <trocar/attempt/press.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::attempt {
namespace {

constexpr double kAbove = 0.015;                                  // of the skin, where the way down begins [m]
constexpr double kBackTo = 0.04;                                  // depth at which instruments swing [m]
constexpr double kQuick = 0.25, kGently = 0.05, kInward = 0.010;  // [m/s]
constexpr double kTurn = 1.5;                                     // [rad/s]
constexpr double kClosing = 4;                                    // [1/s] of the handle
constexpr double kThere = 1e-9;  // [m] or [rad]: rounding may keep a step from ending at its goal to the bit
constexpr int kSteps = 5;        // in which it goes in
constexpr int kHold = 200, kHoldLast = 600, kSettled = 100, kAfter = 300;  // [ticks]
constexpr double kThroughWall = 0.05;            // of the way lies in the wall around the trocar [m]
constexpr double kFacing = 0.3;                  // at least: flatter, it slides off
constexpr double kBeside = 0.001, kOwn = 0.008;  // clear of others; of itself [m]

bool allowed(const interactions::ToolModel& tool, Vec3d tip) {
  const kinematics::FulcrumPose wanted = kinematics::inverse(tool.port, tip, 0);
  const kinematics::FulcrumPose can = kinematics::clamped(wanted, tool.limits);
  return wanted.yaw == can.yaw && wanted.pitch == can.pitch && wanted.depth == can.depth;
}

/// What lies on an instrument's way.
struct Obstacles {
  std::vector<DrawnPoint> others, walls;
  const tissue::Skin& own;

  bool clear(const interactions::ToolModel& tool, Vec3d at) const {
    const double wide = tool.shaft_radius + kBeside;
    const Vec3d inside = tool.port + kThroughWall * normalised(at - tool.port);
    if (points_near(others, tool.port, at, wide) > 0 || points_near(walls, inside, at, wide) > 0) return false;
    return std::none_of(own.rest.begin(), own.rest.end(), [&](Vec3f q) {
      const Vec3d p = vec_cast<double>(q);
      return length(p - at) > kOwn && off_segment(p, tool.port, at) < tool.shaft_radius;
    });
  }
};

std::span<const std::uint8_t> held_of(const sim::Model& model, int organ) {
  const std::int32_t lattice = sim::lattice_of(model, organ);
  return lattice >= 0 ? std::span<const std::uint8_t>(model.solids[std::size_t(lattice)].network.fixed)
                      : std::span<const std::uint8_t>(sim::cuttable_of(model, organ).body.fixed);
}

/// Does it hang on free nodes only?
bool gives_way(std::span<const std::uint8_t> held, const tissue::Skin& skin, int vertex) {
  bool free = true;
  skin.each_carrier(vertex, [&](int node, int, float weight) {
    if (weight > 0 && !held.empty() && held[std::size_t(node)] != tissue::kFree) free = false;
  });
  return free;
}

struct Candidate {
  int triangle = -1;
  Vec3d at, out;      ///< its middle [m], its normal
  double facing = 0;  ///< cosine between the normal and the way to the trocar
};
Candidate candidate(const tissue::Skin& skin, int triangle, Vec3d port) {
  const std::array<int, 3>& t = skin.triangles[std::size_t(triangle)];
  Vec3d corner[3];
  for (std::size_t k = 0; k < 3; ++k) corner[k] = vec_cast<double>(skin.rest[std::size_t(t[k])]);
  const Vec3d at = (corner[0] + corner[1] + corner[2]) / 3.0;
  const Vec3d out = normalised(cross(corner[1] - corner[0], corner[2] - corner[0]));
  return {triangle, at, out, dot(out, normalised(port - at))};
}

/// Triangles that the hand's instrument can press in by `depth`, best first.
std::vector<Candidate> candidates(const sim::Model& model, int organ, int hand, double depth) {
  const tissue::Skin& skin = model.skin(organ);
  const interactions::ToolModel& tool = model.placed(std::size_t(hand));
  const std::span<const std::uint8_t> held = held_of(model, organ);
  std::vector<Candidate> found;
  for (int t = 0; t < int(skin.triangles.size()); ++t) {
    const std::array<int, 3>& corner = skin.triangles[std::size_t(t)];
    if (!std::all_of(corner.begin(), corner.end(), [&](int v) { return gives_way(held, skin, v); })) continue;
    const Candidate c = candidate(skin, t, tool.port);
    if (c.facing > kFacing && allowed(tool, c.at + kAbove * c.out) && allowed(tool, c.at - depth * c.out))
      found.push_back(c);
  }
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.facing > b.facing || (a.facing == b.facing && a.triangle < b.triangle);
  });
  return found;
}

/// Those that leave something behind when they close come last.
std::vector<int> hands_in_order(const sim::Model& model) {
  std::vector<int> hands;
  for (const bool clips : {false, true})
    for (std::size_t h = 0; h < model.hands.size(); ++h)
      if (model.placed(h).can().set_clips == clips) hands.push_back(int(h));
  return hands;
}

/// A tick from one figure towards another. @param speed  [1/s] of its unit
double paced(double from, double to, double speed) {
  return from + std::clamp(to - from, -speed * sim::kTick, speed * sim::kTick);
}

Vec3d middle_of(const sim::Model& model, const sim::State& state, int organ, int triangle) {
  Vec3d sum;
  for (const int v : model.skin(organ).triangles[std::size_t(triangle)])
    sum += tissue::skin_point(nodes_of(model, state, organ), model.skin(organ), v);
  return sum / 3.0;
}

}  // namespace

double organ_size(const sim::Model& model, int organ) {
  tissue::Box box;
  for (const Vec3f& p : model.skin(organ).rest) box.add(p);
  const Vec3d edges = vec_cast<double>(box.high - box.low);
  return std::cbrt(edges.x * edges.y * edges.z);
}

Press plan_press(const sim::Model& model, int organ, double depth) {
  const Obstacles obstacles{drawn_points_but(model, organ), wall_points(model), model.skin(organ)};
  Press blocked;
  for (const int hand : hands_in_order(model)) {
    const std::vector<Candidate> found = candidates(model, organ, hand, depth);
    for (const Candidate& c : found) {
      const interactions::ToolModel& tool = model.placed(std::size_t(hand));
      const bool clear = obstacles.clear(tool, c.at) && obstacles.clear(tool, c.at + kAbove * c.out);
      const Press press{organ, hand, c.triangle, c.at, c.out, depth, clear};
      if (clear) return press;
      if (blocked.hand < 0) blocked = press;
    }
  }
  if (blocked.hand >= 0) return blocked;
  throw core::BadInput({{{"--organ", 0, 0},
                         tr("expected an organ that an instrument can press {:.1f} mm in, got '{}', which no "
                            "hand of {} can press: give recorded hands with --hands, or a "
                            "smaller --depth",
                            1e3 * depth, model.organ_name(organ), model.name)}});
}

PressSource::PressSource(const sim::Model& model, const Press& press)
    : m_model(model),
      m_press(press),
      m_input(model.start),
      m_pose(pose_of(model.start.tools[std::size_t(press.hand)])),
      m_front(model.placed(std::size_t(press.hand)).jaw_thickness),
      m_touched(press.at) {}

void PressSource::go_on(Phase phase) {
  m_phase = phase;
  m_ticks = 0;
}

/// A tick of turning to where `target` is. @return it is there
bool PressSource::turn_to(Vec3d target) {
  const kinematics::FulcrumPose goal =
      kinematics::inverse(m_model.hands[std::size_t(m_press.hand)].port, target, m_pose.roll);
  m_pose.yaw = paced(m_pose.yaw, goal.yaw, kTurn);
  m_pose.pitch = paced(m_pose.pitch, goal.pitch, kTurn);
  return std::fabs(m_pose.yaw - goal.yaw) < kThere && std::fabs(m_pose.pitch - goal.pitch) < kThere;
}

/// A tick of the steps in. Each step's way is followed by a rest.
void PressSource::go_in() {
  const double step = m_press.depth / kSteps;
  const int way = std::max(1, int(step / (kInward * sim::kTick)));
  const int k = std::min(m_ticks / (way + kHold), kSteps - 1), t = m_ticks - k * (way + kHold);
  m_offset = -step * (k + std::min(1.0, double(t) / way));
  if (k == kSteps - 1 && t >= way + kHoldLast) go_on(Phase::out);
}

bool PressSource::settled() const {
  const int way = std::max(1, int(m_press.depth / kSteps / (kInward * sim::kTick)));
  const int last = (kSteps - 1) * (way + kHold) + way + kHoldLast;
  return m_phase == Phase::in && m_ticks > last - kSettled;
}

/// Back along the shaft, over to where it will go in, forth to above the skin.
void PressSource::go_there() {
  const Vec3d above = m_press.at + kAbove * m_press.out;
  const double start = double(m_model.start.tools[std::size_t(m_press.hand)].depth);
  if (m_phase == Phase::swing) {
    if (turn_to(above)) go_on(Phase::forth);
    return;
  }
  const double to =
      m_phase == Phase::back ? std::min(start, kBackTo) : length(above - m_model.hands[std::size_t(m_press.hand)].port);
  m_pose.depth = paced(m_pose.depth, to, kQuick);
  if (std::fabs(m_pose.depth - to) > kThere) return;
  m_offset = kAbove;
  go_on(m_phase == Phase::back ? Phase::swing : Phase::down);
}

/// Towards the skin, until the front is there.
void PressSource::go_down(const sim::State& state) {
  m_offset -= kGently * sim::kTick;
  const Vec3d skin = middle_of(m_model, state, m_press.organ, m_press.triangle);
  if (m_offset > m_front + dot(skin - m_press.at, m_press.out)) return;
  m_touched = skin;
  m_offset = 0;
  go_on(Phase::in);
}

void PressSource::go_out() {
  m_offset = paced(m_offset, kAbove, kGently);
  if (m_offset > kAbove - kThere && m_ticks > kAfter + int(kAbove / (kGently * sim::kTick))) go_on(Phase::over);
}

/// Along the normal the tip's place is what counts: above the skin in the drawn shape, then from where it touched.
void PressSource::aim() {
  const Vec3d port = m_model.hands[std::size_t(m_press.hand)].port;
  if (m_phase == Phase::down)
    m_pose = kinematics::inverse(port, m_press.at + m_offset * m_press.out, m_pose.roll);
  else if (m_phase == Phase::in || m_phase == Phase::out)
    m_pose = kinematics::inverse(port, m_touched + (m_front + m_offset) * m_press.out, m_pose.roll);
}

bool PressSource::next(const sim::State& state, sim::Input& input) {
  ++m_ticks;
  if (m_phase == Phase::over) return false;
  if (m_phase == Phase::out)
    go_out();
  else if (m_phase == Phase::in)
    go_in();
  else if (m_phase == Phase::down)
    go_down(state);
  else
    go_there();
  aim();
  const bool closes = !m_model.placed(std::size_t(m_press.hand)).can().set_clips;
  sim::ToolInput& tool = m_input.tools[std::size_t(m_press.hand)];
  tool = sim::tool_input(m_pose, closes ? float(paced(double(tool.handle), 1, kClosing)) : tool.handle);
  input = m_input;
  return true;
}

Json PressSource::describe() const {
  return {{"instrument", m_model.placed(std::size_t(m_press.hand)).name},
          {"trocar", m_model.hands[std::size_t(m_press.hand)].name},
          {"depth_mm", 1e3 * m_press.depth},
          {"facing", dot(m_press.out, normalised(m_model.hands[std::size_t(m_press.hand)].port - m_press.at))},
          {"at_mm", {1e3 * m_press.at.x, 1e3 * m_press.at.y, 1e3 * m_press.at.z}},
          {"clear", m_press.clear}};
}

}  // namespace trocar::attempt
