// A hand that leads the needle which it holds, for tests: wanted is where the needle shall be, and the instrument goes
// where that asks it to.
#pragma once

#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar {

class NeedleDriver {
 public:
  NeedleDriver(const sim::Model& model, int hand)
      : m_model(model),
        m_hand(hand),
        state(sim::initial_state(model)),
        work(sim::make_work(model)),
        input(model.start) {}
  NeedleDriver(const NeedleDriver& other)
      : m_model(other.m_model),
        m_hand(other.m_hand),
        state(other.state),
        work(sim::make_work(m_model)),
        input(other.input) {}

  const interactions::SutureModel& model() const { return m_model.objects.sutures.list.front(); }
  const interactions::SutureState& suture() const { return state.objects.sutures.front(); }
  int hand() const { return m_hand; }
  Vec3d tip() const { return suture::needle_point(model().needle, suture().needle, 0); }

  sim::StepReport step() {
    const sim::StepReport report = sim::step(m_model, input, state, work);
    flags |= report.flags;
    events.insert(events.end(), report.events, report.events + report.event_count);
    if (suture().bite_count == 0) before_entry = suture().peak;
    return report;
  }
  void rest(double seconds) {
    for (int i = 0; i < int(seconds / sim::kTick); ++i) step();
  }

  /// The needle's middle and turn with the tip at `angle` beyond `in` on its circle to `out`.
  void pose(Vec3d in, Vec3d out, double angle, Vec3d& x, Quatd& q) const {
    const suture::NeedleModel& m = model().needle;
    const Vec3d port = m_model.hands[size_t(m_hand)].port, middle = 0.5 * (in + out);
    const double half = 0.5 * length(out - in);
    Vec3d axis = normalised(middle - port), rises, centre;
    for (int k = 0; k < 12; ++k) {
      rises = normalised(Vec3d{0, 0, 1} - axis.z * axis);
      centre = middle + std::sqrt(m.radius * m.radius - half * half) * rises;
      axis = normalised(centre + m.radius * rises - port);
    }
    const Vec3d out_of = rotate(quat_from_axis_angle(axis, angle), normalised(in - centre));
    const Vec3d own = normalised(m.place(0) - m.centre), z{0, 0, 1};
    const Mat3d from = Mat3d::from_columns(own, cross(z, own), z);
    const Mat3d to = Mat3d::from_columns(out_of, cross(axis, out_of), axis);
    q = quat_from_mat3(to * transposed(from));
    x = centre - rotate(q, m.centre);
  }
  void lead(Vec3d x, Quatd q) {
    const interactions::ToolModel& tool = m_model.tool(state, size_t(m_hand));
    const interactions::ToolShape shape = sim::shape_of(m_model, state, size_t(m_hand));
    const Vec3d tip_now = x + rotate(q, suture::own_of(suture().needle, shape.frame.tip));
    const Vec3d normal = rotate(q, rotate(conjugate(suture().needle.q), direction_from_jaw(shape, {0, 1, 0})));
    const auto normal_at = [&](double roll) {
      return direction_from_jaw(shape_of(tool, kinematics::inverse(tool.port, tip_now, roll), 0.1), {0, 1, 0});
    };
    const Vec3d axis = normalised(tip_now - tool.port), across = normal - dot(normal, axis) * axis;
    double roll = portable::atan2(dot(cross(normal_at(0), across), axis), dot(normal_at(0), across));
    if (dot(cross(normal_at(0), normal_at(0.1)), axis) < 0) roll = -roll;
    const double now = state.tools[size_t(m_hand)].roll;
    while (roll - now > portable::pi) roll -= 2 * portable::pi;
    while (roll - now < -portable::pi) roll += 2 * portable::pi;
    input.tools[m_hand] = sim::tool_input(kinematics::inverse(tool.port, tip_now, roll), 1.0f);
  }
  /// Over the pad, down before `in`, and along the arc to `last` [rad] beyond it in `seconds`.
  void drive(Vec3d in, Vec3d out, double last, double seconds) {
    const Vec3d x0 = suture().needle.x;
    const Quatd q0 = suture().needle.q;
    Vec3d x;
    Quatd q;
    pose(in, out, -0.3, x, q);
    const Vec3d high = x + Vec3d{0, 0, 0.02};
    const auto go = [&](double time, auto&& to) {
      const int ticks = int(time / sim::kTick);
      for (int i = 1; i <= ticks; ++i) to(double(i) / ticks), step();
    };
    go(1.2, [&](double f) { lead(x0 + f * (high - x0) + Vec3d{0, 0, 0.048 * f * (1 - f)}, slerp(q0, q, f)); });
    go(0.6, [&](double f) { lead(high + f * (x - high), q); });
    go(seconds, [&](double f) {
      pose(in, out, -0.3 + f * (last + 0.3), x, q);
      lead(x, q);
    });
  }

 private:
  const sim::Model& m_model;
  int m_hand;

 public:
  sim::State state;
  sim::Work work;
  sim::Input input;
  std::uint32_t flags = 0;
  std::vector<sim::Event> events;  ///< of all ticks
  double before_entry = 0;         ///< the most that the needle did to tissue until it was pierced first [N]
};

}  // namespace trocar
