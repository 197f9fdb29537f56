#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/stages/pulse_feel.hpp>

namespace trocar::sim {
namespace {

Vec3d on_segment(Vec3d p, Vec3d a, Vec3d b) noexcept { return a + geometry::closest_on_segment(p, a, b) * (b - a); }
double away(Vec3d p, Vec3d a, Vec3d b) noexcept { return length(p - on_segment(p, a, b)); }

}  // namespace

bool presses(const State& state, size_t hand) noexcept {
  const double(&f)[3] = state.tools[hand].contact_force;
  return f[0] != 0 || f[1] != 0 || f[2] != 0;
}

PulseTouch pulse_touch(const interactions::ToolShape& shape, Vec3d at, double radius) noexcept {
  if (shape.links == 0 && away(at, shape.part[interactions::kShaft].a, shape.frame.tip) > kNearSheet) return {};
  double nearest = kFelt;
  Vec3d towards;
  for (int number = interactions::kShaft; number < end_of(shape); number = interactions::next(number)) {
    const collision::Capsule& part = shape.rod(number);
    const Vec3d axis = on_segment(at, part.a, part.b);
    const double between = std::max(length(axis - at) - part.radius - radius, 0.0);
    if (between >= nearest) continue;
    nearest = between;
    towards = normalised(axis - at, {0, 0, 0});
  }
  return nearest < kFelt ? PulseTouch{1 - nearest / kFelt, towards} : PulseTouch{};
}

double stands_for(const interactions::VesselPath& path, size_t i) noexcept {
  return 0.5 * path.length * (path.points[i + 1].s - path.points[i - 1].s);
}

PulseReader::PulseReader(const Model& model) : m_model(model) {
  size_t longest = 0;
  for (const Vessel& v : model.vessels.list) longest = std::max(longest, v.path.points.size());
  m_line.resize(longest);
}

double PulseReader::area(const State& state, int hand, int vessel) {
  const Vessel& v = m_model.vessels.list[size_t(vessel)];
  if (!v.pulses() || !presses(state, size_t(hand))) return 0;
  const interactions::ToolShape shape = shape_of(m_model, state, size_t(hand));
  const std::span<Vec3d> line = std::span(m_line).first(v.path.points.size());
  pose_vessel(v.path, bodies_of(m_model, state), line);
  double sum = 0;
  for (size_t i = 1; i + 1 < line.size(); ++i) {
    const interactions::VesselPoint& p = v.path.points[i];
    if (p.rides.in_space()) continue;
    sum += 2 * p.radius * stands_for(v.path, i) * pulse_touch(shape, line[i], p.radius).share;
  }
  return sum;
}

double PulseReader::force(const State& state, int hand) {
  double sum = 0;
  for (size_t v = 0; v < m_model.vessels.list.size(); ++v) {
    const Vessel& vessel = m_model.vessels.list[v];
    const double through = area(state, hand, int(v));
    if (!(through > 0)) continue;
    const double pressure = vessels::read_wall(m_model.vessels.flow, state.flow, int(v), 0.5).pressure;
    sum += std::max(0.0, vessel.gain * (pressure - vessel.mean_pressure)) * through;
  }
  return sum;
}

double PulseReader::beat(const State& state, int hand, int vessel) {
  const vessels::Vitals v = vessels::vitals(m_model.vessels.flow, state.flow);
  const Vessel& of = m_model.vessels.list[size_t(vessel)];
  return of.vein ? 0 : of.gain * (v.systolic - v.diastolic) * area(state, hand, vessel);
}

}  // namespace trocar::sim
