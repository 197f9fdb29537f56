#include <algorithm>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/surgeon/surgeon.hpp>

namespace trocar::training {
namespace {

constexpr double kDistance = 0.06;  // [m] of the lens from what it shows, unless a skill wants another

}  // namespace

Surgeon::Surgeon(const sim::Model& model, const Tremor& tremor) : m_arms(model, tremor), m_camera(model) {
  for (size_t h = 0; h < hands(model); ++h) {
    const std::string& name = model.hands[h].name;
    m_jaws[h] = {model.target_index(name + ".jaw_a"), model.target_index(name + ".jaw_b")};
  }
}

void Surgeon::begin_tick(const sim::Model& model, const sim::State& state) {
  m_model = &model;
  m_state = &state;
  m_point_count = 0;
  m_distance = kDistance;
  m_facing.reset();
  m_declares = false;
  m_posed_vessel = -1;
  m_arms.begin_tick();
}

sim::Input Surgeon::end_tick() {
  if (m_point_count > 0) m_camera.show({m_points.data(), size_t(m_point_count)}, m_distance, m_facing);
  sim::Input input = m_model->start;
  m_arms.fill(m_state->tick, input);
  m_camera.fill(input);
  if (m_declares) input.pedals |= sim::kDeclare;
  m_model = nullptr;
  m_state = nullptr;
  return input;
}

bool Surgeon::sees_tip(int hand) const {
  const auto& jaws = m_jaws[size_t(hand)];
  return sim::visible(*m_model, *m_state, jaws[0]) || sim::visible(*m_model, *m_state, jaws[1]);
}

bool Surgeon::sees_jaws(int hand) const {
  const auto& jaws = m_jaws[size_t(hand)];
  return sim::visible(*m_model, *m_state, jaws[0]) && sim::visible(*m_model, *m_state, jaws[1]);
}

Vec3d Surgeon::point(int strand, double s) const {
  const interactions::StrandBody& body = m_model->strand_bodies[size_t(strand)];
  return interactions::point_at(body, m_state->strands[size_t(strand)], interactions::place_at(body, s));
}

Vec3d Surgeon::tangent(int strand, double s) const {
  const interactions::StrandBody& body = m_model->strand_bodies[size_t(strand)];
  return interactions::tangent_at(body, m_state->strands[size_t(strand)], interactions::place_at(body, s));
}

double Surgeon::radius(int strand, double s) const {
  const interactions::StrandBody& body = m_model->strand_bodies[size_t(strand)];
  return body.model.radius[size_t(interactions::place_at(body, s).element)];
}

int Surgeon::cut_element(int strand) const {
  const std::vector<std::uint8_t>& alive = m_state->strands[size_t(strand)].alive;
  for (size_t e = 0; e < alive.size(); ++e)
    if (!alive[e]) return int(e);
  return -1;
}

Vec3d Surgeon::sample_point(const sim::VisibilitySample& sample) const {
  const sim::VisibilityTarget& t = m_model->targets[size_t(sample.target)];
  if (t.kind == sim::VisibilityTarget::organ)  // where one knows it to lie
    return vec_cast<double>(m_model->skin(t.index).rest[size_t(sample.where)]);
  return place_of(*m_model, *m_state, sample);
}

Vec3d Surgeon::middle_of(int target) const {
  const sim::VisibilityTarget& t = m_model->targets[size_t(target)];
  Vec3d sum;
  for (int i = t.first; i < t.first + t.count; ++i) sum += sample_point(m_model->samples[size_t(i)]);
  return sum / std::max(1, t.count);
}

interactions::VesselSpot Surgeon::vessel_spot(int vessel, double s) {
  const interactions::VesselPath& path = m_model->vessels.list[size_t(vessel)].path;
  if (m_posed_vessel != vessel) {
    m_line.resize(path.points.size());
    pose_vessel(path, bodies_of(*m_model, *m_state), m_line);
    m_posed_vessel = vessel;
  }
  return interactions::vessel_spot(path, m_line, {}, s);
}

namespace {

/// Can this go straight to a point of the pool, or is what the pool lies on in its way?
bool free_way(const fluids::PoolModel& pool, const std::vector<float>& floor, Vec3d from, Vec3d to) {
  constexpr double kClear = 0.006, kLast = 0.012, kStep = 0.004;  // [m] above the floor; of the way; between looks
  const Vec3d way = to - from;
  for (double s = kLast; s < length(way); s += kStep) {
    const fluids::PoolPoint p = locate(pool, to - s * normalised(way));
    if (p.inside && p.height < floor_at(pool, floor, p.i, p.j) + kClear) return false;
  }
  return true;
}

}  // namespace

std::optional<Vec3d> Surgeon::deepest_pool(int hand) const {
  const fluids::PoolModel& pool = m_model->wet.model.pool;
  constexpr float kShallow = 0.0002f;  // [m]
  float most = kShallow;
  std::optional<Vec3d> found;
  if (!m_model->wet.there) return found;
  for (int j = 0; j < pool.ny; ++j)
    for (int i = 0; i < pool.nx; ++i) {
      const float d = depth_at(pool, m_state->fluids.pool, i, j);
      if (d <= most) continue;
      const double height = double(floor_at(pool, m_state->pool_floor, i, j)) + 0.5 * double(d);
      const Vec3d at = world(pool, (i + 0.5) * pool.cell, (j + 0.5) * pool.cell, height);
      if (free_way(pool, m_state->pool_floor, m_arms[hand].port, at)) most = d, found = at;
    }
  return found;
}

void Surgeon::want(Vec3d p) {
  if (m_point_count < int(m_points.size())) m_points[size_t(m_point_count++)] = p;
}

void Surgeon::want_all_of(int target) {
  const sim::VisibilityTarget& t = m_model->targets[size_t(target)];
  constexpr int kPoints = 5;
  for (int k = 0; k < kPoints; ++k)
    want(sample_point(m_model->samples[size_t(t.first + k * (t.count - 1) / (kPoints - 1))]));
}

bool Surgeon::aim(int hand, Vec3d at, Vec3d along, double inside, double back, double speed) {
  const Vec3d axis = normalised(at - m_arms[hand].port);
  const bool there = m_arms.move(hand, at + (tool(hand).jaw_length - inside - back) * axis, speed);
  return m_arms.turn_across(hand, along) && there;
}

interactions::ToolShape Surgeon::shape_at(int hand, Vec3d at, Vec3d along, double inside) const {
  const interactions::ToolModel& model = tool(hand);
  const Vec3d port = m_arms[hand].port, axis = normalised(at - port);
  kinematics::FulcrumPose pose = kinematics::inverse(port, at + (model.jaw_length - inside) * axis, m_arms[hand].roll);
  pose.roll = kinematics::roll_towards(pose, along);
  return interactions::shape_of(model, pose, {}, tool_state(hand).aperture, port - model.port);
}

bool Surgeon::aim_at(int hand, int strand, double s, double inside, double back, double speed) {
  return aim(hand, point(strand, s), tangent(strand, s), inside, back, speed);
}

bool Surgeon::approach(int hand, int strand, double s, double inside, double waited) {
  constexpr double kUnseen = 3;  // [s] to wait for the camera
  want(m_arms[hand].tip);
  const bool deep = tool_state(hand).depth > reach::kIdle;
  if (deep && !sees_tip(hand) && waited < kUnseen) return false;
  if (!deep && !m_camera.settled() && waited < kUnseen) return false;
  return aim_at(hand, strand, s, inside, reach::kBefore, pace::kTravel);
}

void Surgeon::draw_back(int hand) {
  if (tool_state(hand).depth > reach::kIdle) m_arms.move_to_depth(hand, reach::kIdle, pace::kTravel);
}

void Surgeon::make_room(int but_hand) {
  for (int h = 0; h < m_arms.count(); ++h)
    if (h != but_hand && tool_state(h).holds == 0 && !m_posture[size_t(h)].up()) draw_back(h);
}

int Surgeon::who_presents(int strand) const {
  for (int h = 0; h < m_arms.count(); ++h)
    if (m_posture[size_t(h)].up() && m_posture[size_t(h)].aim().strand == strand) return h;
  return -1;
}

void Surgeon::keep_postures(int strand, double s) {
  if (const int h = who_presents(strand); h >= 0) m_posture[size_t(h)].keep(*this, s);
}

bool Surgeon::still_presented(int strand) const {
  const int h = who_presents(strand);
  return h < 0 || m_posture[size_t(h)].holding(*this);
}

}  // namespace trocar::training
