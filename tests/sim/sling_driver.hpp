// A hand with a loop at the end of its tube, for tests: wanted is where the mouth shall be and which way the plane of
// the loop shall face.
#pragma once

#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar {

class SlingDriver {
 public:
  SlingDriver(const sim::Model& model, int hand)
      : m_model(model),
        m_hand(hand),
        state(sim::initial_state(model)),
        work(sim::make_work(model)),
        input(model.start) {
    const sim::ToolInput& t = input.tools[m_hand];
    m_tip = kinematics::forward(port(), {t.yaw, t.pitch, t.roll, t.depth}).tip;
    m_roll = t.roll;
    handle = 1;
  }
  SlingDriver(const SlingDriver& other)
      : m_model(other.m_model),
        m_hand(other.m_hand),
        m_tip(other.m_tip),
        m_roll(other.m_roll),
        state(other.state),
        work(sim::make_work(m_model)),
        input(other.input),
        handle(other.handle),
        events(other.events),
        in_hand(other.in_hand) {}

  Vec3d port() const { return m_model.tool(state, size_t(m_hand)).port; }
  const interactions::SutureModel& model() const { return m_model.objects.sutures.list[in_hand]; }
  const interactions::SutureState& suture() const { return state.objects.sutures[in_hand]; }
  const interactions::SlingState& sling() const { return suture().sling; }
  Vec3d tip() const { return m_tip; }
  Vec3d axis() const { return sling().mouth.axis; }
  /// Of the loop's middle.
  Vec3d middle() const {
    const int count = std::max(1, suture::place_at(model().thread, sling().knot).element + 1);
    Vec3d sum;
    for (int n = 0; n < count; ++n) sum += suture().thread.x[size_t(n)];
    return sum / double(count);
  }
  Vec3d point(int strand, double s) const {
    const interactions::StrandPlace p = interactions::place_at(m_model.strand_bodies[size_t(strand)], s);
    const auto& x = state.strands[size_t(strand)].x;
    return x[size_t(p.element)] + p.w * (x[size_t(p.element) + 1] - x[size_t(p.element)]);
  }

  sim::StepReport step() {
    const kinematics::FulcrumPose pose = kinematics::inverse(port(), m_tip, m_roll);
    input.tools[m_hand] = sim::tool_input(pose, float(handle), input.tools[m_hand].instrument);
    const sim::StepReport report = sim::step(m_model, input, state, work);
    flags |= report.flags;
    for (int i = 0; i < report.event_count; ++i) ++events[size_t(report.events[i].kind)];
    most = std::max(most, suture().strain);
    return report;
  }
  void rest(double seconds) {
    for (int i = 0; i < int(seconds / sim::kTick); ++i) step();
  }
  void jump(Vec3d tip) { m_tip = tip; }
  /// The mouth goes to `to` at `speed`.
  void move(Vec3d to, double speed = 0.03) {
    const Vec3d from = m_tip;
    const int ticks = std::max(1, int(length(to - from) / speed / sim::kTick));
    for (int i = 1; i <= ticks; ++i) m_tip = from + (double(i) / ticks) * (to - from), step();
  }
  /// The loop's plane turns to stand across `normal`, as far as it can.
  void face(Vec3d normal, double seconds = 0.5) {
    const kinematics::FulcrumPose pose = kinematics::inverse(port(), m_tip, m_roll);
    const Vec3d out = normalised(m_tip - port());
    double left = kinematics::roll_towards(pose, cross(normal, out)) - m_roll;
    while (left > 0.5 * portable::pi) left -= portable::pi;
    while (left < -0.5 * portable::pi) left += portable::pi;
    const int ticks = int(seconds / sim::kTick);
    for (int i = 0; i < ticks; ++i) m_roll += left / ticks, step();
  }
  void grip(double to, double seconds) {
    const double from = handle;
    const int ticks = std::max(1, int(seconds / sim::kTick));
    for (int i = 1; i <= ticks; ++i) handle = from + (to - from) * i / ticks, step();
  }
  Vec3d tangent(int strand, double s) const { return normalised(point(strand, s + 0.004) - point(strand, s - 0.004)); }
  /// Where the mouth shall be so that a loop with so much thread has that place of the strand in its middle; the less
  /// thread, the more the knot stands level with it.
  Vec3d mouth_for(int strand, double s, double thread) {
    const double back = std::max(0.0058, 0.265 * thread), slanting = std::clamp((back - 0.006) / 0.01, 0.0, 1.0);
    if (thread > 0.045) m_at = point(strand, s), m_along = tangent(strand, s);  // what it touches gives way
    const Vec3d at = m_at, n = m_along, out = normalised(at - port());
    const Vec3d level = normalised(out - dot(out, n) * n);
    return at - back * normalised(slanting * out + (1 - slanting) * level);
  }
  /// From above, over the strand's free end at `end` and down to s.
  void put_over(int strand, double end, double s) {
    const Vec3d above = 0.012 * tangent(strand, end - 0.005);
    move(mouth_for(strand, end, model().sling.loop) + 2 * above);
    face(tangent(strand, end - 0.005));
    grip(0, 0.3);
    rest(2.6);
    move(mouth_for(strand, end, model().sling.loop) + above);
    for (double at = end - 0.002; at > s; at -= 0.004) {
      move(mouth_for(strand, at, model().sling.loop), 0.02);
      face(tangent(strand, at), 0.1);
    }
    move(mouth_for(strand, s, model().sling.loop), 0.02);
    face(tangent(strand, s), 0.3);
  }
  /// The handle closes to `to`, at first until the loop lies around it; the mouth follows.
  void draw_closed(int strand, double s, double to, double seconds) {
    for (int i = 0; i < int(seconds / sim::kTick); ++i) {
      const bool lies = sling().tension > 0.4;
      handle = std::min(to, handle + (handle < 0.25 || lies ? 0.0005 : 0.0));
      const Vec3d go = mouth_for(strand, s, sling().fed) - m_tip;
      const double far = 0.04 * sim::kTick;
      m_tip += std::min(1.0, far / std::max(1e-9, length(go))) * go;
      step();
    }
  }
  int told(sim::Event::Kind kind) const { return events[size_t(kind)]; }

 private:
  const sim::Model& m_model;
  int m_hand;
  Vec3d m_tip;
  double m_roll = 0;
  Vec3d m_at, m_along{0, 0, 1};  ///< of the strand, before the loop touches it

 public:
  sim::State state;
  sim::Work work;
  sim::Input input;
  double handle = 1;
  std::array<int, 64> events{};
  std::uint32_t flags = 0;
  std::size_t in_hand = 0;  ///< which of the scene's slings
  double most = 0;          ///< tension in its thread so far [N]
};

}  // namespace trocar
