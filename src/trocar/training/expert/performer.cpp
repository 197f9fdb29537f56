#include <fmt/format.h>

#include <trocar/training/expert/performer.hpp>
#include <trocar/training/observe/sampling.hpp>

namespace trocar::training {
namespace {

constexpr size_t kMostDifficulties = 100;  // that are told

}  // namespace

Performer::Task Performer::make(const sim::Model& model, const PlanTask& task) {
  Task made{&task, task.kind->make(model, Given(*task.kind, task.arguments)), make(model, task.meanwhile)};
  if (task.wrap) made.skill = task.wrap(std::move(made.skill));
  return made;
}

std::vector<Performer::Task> Performer::make(const sim::Model& model, const std::vector<PlanTask>& tasks) {
  std::vector<Task> made;
  for (const PlanTask& task : tasks) made.push_back(make(model, task));
  return made;
}

Performer::Performer(const sim::Model& model, Demonstration demonstration, const Manner& manner)
    : m_demonstration(std::move(demonstration)), m_plan(m_demonstration.plan), m_operator(model, manner.tremor) {
  for (const PlanPart& part : m_plan.parts) {
    std::vector<Goal>& goals = m_parts.emplace_back();
    for (const PlanGoal& goal : part.goals) {
      Goal& made = goals.emplace_back();
      made.plan = &goal;
      made.todo = make(model, goal.todo);
      made.if_failed = make(model, goal.if_failed);
    }
  }
}

const char* Performer::doing() const {
  if (m_done) return "done";
  if (!m_goal || m_pause > 0) return "think";
  const std::vector<Task>& list = m_repairing ? m_goal->if_failed : m_goal->todo;
  return m_task < list.size() ? list[m_task].plan->kind->doing.data() : "think";
}

void Performer::stop(bool gave_up) {
  m_done = true;
  m_gave_up = m_gave_up || gave_up;
}

bool Performer::is_reached(const Goal& goal) const {
  if (goal.given_up) return true;
  return goal.plan->until.there() ? goal.plan->until.holds(moment()) == Truth::yes : goal.reached;
}

void Performer::choose() {
  for (; m_part < m_parts.size(); ++m_part, m_in_part = 0) {
    for (Goal& goal : m_parts[m_part])
      if (!is_reached(goal)) {
        m_goal = &goal;
        m_repairing = false;
        return begin(0);
      }
    const bool same_set = m_part + 1 < m_parts.size() && m_plan.parts[m_part + 1].group == part().group;
    if (same_set && part().pause > 0) {
      m_pause = part().pause;
      ++m_part;
      m_in_part = 0;
      return;
    }
  }
  stop(false);
}

void Performer::begin(size_t task) {
  m_task = task;
  m_in_task = 0;
  if (task == 0 && !m_repairing) ++m_goal->tries;
  if (task >= tasks().size()) {  // nothing to do for it
    m_goal->given_up = true;
    return think();
  }
  Task& next = tasks()[task];
  next.skill->begin(m_operator, m_goal->tries - 1);
  for (Task& beside : next.meanwhile) beside.skill->begin(m_operator, m_goal->tries - 1);
}

void Performer::think() {
  m_pause = part().pause;
  if (m_pause == 0) choose();
}

void Performer::failed(const std::string& why) {
  Goal& goal = *m_goal;
  ++goal.failures;
  if (m_difficulties.size() < kMostDifficulties)
    m_difficulties.push_back(fmt::format("{:.1f} s: {}{}: {}", moment().now(), goal.plan->name,
                                         goal.plan->element.empty() ? "" : " (" + goal.plan->element + ")", why));
  if (goal.plan->tries > 0 && goal.failures >= goal.plan->tries) {
    goal.given_up = m_gave_up = true;
    return think();
  }
  if (goal.if_failed.empty() || goal.failures % goal.plan->every != 0) return think();
  m_repairing = true;
  begin(0);
}

void Performer::ended(Progress how, const std::string& why) {
  if (m_repairing) {  // one after the other, whatever becomes of them
    if (m_task + 1 < tasks().size()) return begin(m_task + 1);
    return think();
  }
  if (how == Progress::failed) return failed(why);
  if (m_task + 1 < tasks().size()) return begin(m_task + 1);
  m_goal->reached = true;
  if (!is_reached(*m_goal)) return failed("all was done, and it is not so");
  think();
}

void Performer::go_on(double passed) {
  if (m_pause > 0) {
    if (--m_pause == 0) choose();
  } else if (!m_done) {
    work(passed);
  }
}

void Performer::work(double passed) {
  Task& task = tasks()[m_task];
  m_in_task += passed;
  if (m_in_task > task.plan->at_most) {
    const bool goes_on = task.plan->goes_on;
    ended(goes_on ? Progress::done : Progress::failed, fmt::format("{}: it took too long", task.plan->kind->name));
    if (goes_on && m_pause > 0) {  // who has lost patience thinks no more
      m_pause = 0;
      choose();
    }
    return go_on(0);  // in the same tick
  }
  for (Task& beside : task.meanwhile) beside.skill->tick(m_operator, passed);
  Progress how = task.skill->tick(m_operator, passed);
  if (how == Progress::working && task.plan->until.there() && task.plan->until.holds(moment()) == Truth::yes)
    how = Progress::done;
  if (how != Progress::working) ended(how, fmt::format("{}: {}", task.plan->kind->name, task.skill->why()));
}

sim::Input Performer::next(const sim::Model& model, const sim::State& state) {
  m_operator.begin_tick(model, state);
  if (!m_begun) {
    m_begun = true;
    choose();
  }
  m_in_part += sim::kTick;
  if (!m_done && m_in_part > part().at_most) stop(true);
  if (!m_done) go_on(sim::kTick);
  return m_operator.end_tick();
}

void Performer::after(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  const Moment now{model, state};
  if (FactWatches* watches = m_demonstration.watches.get()) {
    watches->tick(now, report);
    if (state.tick % kSampleEvery == 0) watches->sample(now, kSample);
  }
  if (m_demonstration.judge) m_demonstration.judge->update(model, state, report);
}

}  // namespace trocar::training
