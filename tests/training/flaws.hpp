// Mistakes for tests: what is changed in the plan of a demonstration so that whoever performs it makes one. Most are a
// parameter (close in 0.6 s, clip 31.5 mm out, take that strand); some are skills that nobody should have.
#pragma once

#include <algorithm>
#include <functional>

#include <trocar/training/expert/performer.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training::flaws {

/// A skill that a test writes on the spot.
class Antic : public Skill {
 public:
  using Do = std::function<Progress(Surgeon&, double now)>;  ///< since it began [s]
  explicit Antic(Do what) : m_what(std::move(what)) {}

 private:
  Progress work(Surgeon& op) override { return m_what(op, m_in_phase); }
  Do m_what;
};

/// Instead of the skill that stands there.
inline void replace(PlanTask& task, Antic::Do what) {
  task.at_most = 60;
  task.goes_on = true;
  task.wrap = [what](std::unique_ptr<Skill>) { return std::make_unique<Antic>(what); };
}
/// Before it, in the same goal; once.
inline PlanTask& insert(PlanGoal& goal, size_t before, PlanTask task) {
  task.goes_on = true;
  return *goal.todo.insert(goal.todo.begin() + std::ptrdiff_t(before), std::move(task));
}
inline void insert(PlanGoal& goal, size_t before, Antic::Do what) {
  const auto done = std::make_shared<bool>(false);
  replace(insert(goal, before, PlanTask::of(kHold)), [what, done](Surgeon& op, double now) {
    if (*done) return Progress::done;
    const Progress p = what(op, now);
    *done = p != Progress::working;
    return p;
  });
}

/// The same goal once more before it, tried once: to be done wrongly.
inline PlanGoal& first_wrongly(Plan& plan, std::string_view name) {
  for (PlanPart& part : plan.parts)
    for (size_t i = 0; i < part.goals.size(); ++i)
      if (part.goals[i].name == name) {
        PlanGoal wrong = part.goals[i];
        wrong.tries = 1;
        return *part.goals.insert(part.goals.begin() + std::ptrdiff_t(i), std::move(wrong));
      }
  throw std::out_of_range("the plan has no such goal");
}

/// Does what the skill does, and then this to what the camera or the hands shall do.
class Distracted : public Skill {
 public:
  Distracted(std::unique_ptr<Skill> skill, std::function<void(Surgeon&)> then)
      : m_skill(std::move(skill)), m_then(std::move(then)) {}

 private:
  void start(Surgeon& op, int tries) override { m_skill->begin(op, tries); }
  Progress work(Surgeon& op) override {
    const Progress p = m_skill->tick(op);
    m_then(op);
    return p;
  }
  std::unique_ptr<Skill> m_skill;
  std::function<void(Surgeon&)> m_then;
};
inline void distract(PlanTask& task, std::function<void(Surgeon&)> then) {
  task.wrap = [then](std::unique_ptr<Skill> s) { return std::make_unique<Distracted>(std::move(s), then); };
}

/// The camera on the other side of the patient from this place.
inline void look_away(Surgeon& op, Vec3d from) {
  op.want_nothing();
  op.want({-3 * from.x, from.y, from.z});
}

/// Raises what a hand holds without looking at how hard it pulls, until `enough`.
inline Antic::Do raise(int hand, std::function<bool(Surgeon&)> enough) {
  return [hand, enough](Surgeon& op, double) {
    if (enough(op)) return Progress::done;
    Arms::Arm& arm = op.arm(hand);
    op.want(arm.tip);
    arm.tip += pace::kCareful * sim::kTick * normalised(Vec3d{arm.tip.x > 0 ? 0.35 : -0.35, 0.10, 1.0});
    return Progress::working;
  };
}

/// Takes a fold of an organ where it is seen, and nothing else is near, with all strength.
class Pinch {
 public:
  Pinch(int hand, int mark) : m_hand(hand), m_mark(mark) {}

  Progress operator()(Surgeon& op, double now) {
    constexpr double kClear = 0.02;  // [m]
    const interactions::ToolModel& t = op.tool(m_hand);
    const Vec3d port = op.arm(m_hand).port;
    if (m_stage == 0) {
      op.want(op.middle_of(m_mark));
      if (now < 2 || !choose(op, kClear)) return Progress::working;
      m_stage = 1;
    }
    const Vec3d axis = normalised(m_at - port);
    op.want(m_at);
    op.want(op.arm(m_hand).tip);
    const bool turned = op.arms().turn_across(m_hand, m_along);
    const double deep = 0.4 * t.jaw_length + 0.003 * m_attempts;  // deeper when it did not come at once
    Arms& arms = op.arms();
    if (m_stage == 1 && arms.move(m_hand, port + reach::kBroughtIn * axis, pace::kTravel)) m_stage = 2;
    if (m_stage == 2 && arms.move(m_hand, m_at - 0.015 * axis, pace::kTravel) && turned) m_stage = 3;
    if (m_stage == 3 && arms.move(m_hand, m_at + deep * axis, pace::kCareful)) m_stage = 4;
    if (m_stage == 4 && arms.grip(m_hand, 1, 1.0)) m_stage = op.tool_state(m_hand).holds > 0 ? 6 : 5;
    if (m_stage == 5 && arms.grip(m_hand, 0, 0.5)) ++m_attempts, m_stage = 3;
    if (m_stage == 6 && arms.grip(m_hand, 0, 1.0)) m_stage = 7;
    return m_stage == 7 && arms.move(m_hand, m_at - 0.02 * axis, pace::kCareful) ? Progress::done : Progress::working;
  }

 private:
  static double from_strands(Surgeon& op, Vec3d at) {
    double least = 1e9;
    for (const tissue::StrandState& strand : op.state().strands)
      for (const Vec3d& x : strand.x) least = std::min(least, length(x - at));
    return least;
  }

  /// Between two neighbouring points of its skin, the jaws' width along them.
  bool choose(Surgeon& op, double clear) {
    const sim::VisibilityTarget& seen = op.model().targets[size_t(m_mark)];
    const Vec3d port = op.arm(m_hand).port;
    double least = 1e9;
    int vertex = -1;
    for (int i = seen.first; i < seen.first + seen.count; ++i) {
      const Vec3d at = op.sample_point(op.model().samples[size_t(i)]);
      const double cost = length(at - port) - 4 * std::min(from_strands(op, at), clear);
      if (!op.state().seen[size_t(i)] || cost >= least) continue;
      least = cost;
      vertex = op.model().samples[size_t(i)].where;
    }
    if (vertex < 0) return false;
    const tissue::Skin& skin = op.model().skin(seen.index);
    const Vec3d at = vec_cast<double>(skin.rest[size_t(vertex)]);
    double nearest = 1e9;
    for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k)
      for (const int other : skin.triangles[size_t(skin.face[size_t(k)])]) {
        const Vec3d along = vec_cast<double>(skin.rest[size_t(other)]) - at;
        if (other == vertex || length(along) >= nearest) continue;
        nearest = length(along);
        m_along = along;
      }
    m_at = at + 0.5 * m_along;
    return true;
  }

  int m_hand, m_mark, m_stage = 0, m_attempts = 0;
  Vec3d m_at, m_along;
};

}  // namespace trocar::training::flaws
