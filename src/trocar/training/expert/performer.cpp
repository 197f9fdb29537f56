#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/expert/performer.hpp>
#include <trocar/training/expert/perturbation.hpp>
#include <trocar/training/observe/sampling.hpp>

namespace trocar::training {
namespace {

constexpr size_t kMostDifficulties = 100;  // that are reported

}  // namespace

std::unique_ptr<Skill> Performer::skill_of(const sim::Model& model, const PlanTask& task) {
  std::unique_ptr<Skill> skill = task.kind->make(model, SkillArgs(*task.kind, task.arguments));
  return task.wrap ? task.wrap(std::move(skill)) : std::move(skill);
}

Performer::Task Performer::make(const sim::Model& model, const PlanTask& task) {
  return {&task, skill_of(model, task), make(model, task.meanwhile)};
}

/// The same tasks, done otherwise.
void Performer::make_anew(const sim::Model& model, const PlanTask& otherwise, Task& task) {
  task.skill = skill_of(model, otherwise);
  for (size_t i = 0; i < task.meanwhile.size(); ++i) make_anew(model, otherwise.meanwhile[i], task.meanwhile[i]);
}

std::vector<Performer::Task> Performer::make(const sim::Model& model, const std::vector<PlanTask>& tasks) {
  std::vector<Task> made;
  for (const PlanTask& task : tasks) made.push_back(make(model, task));
  return made;
}

std::vector<Performer::Goal> Performer::make(const sim::Model& model, const PlanPart& part) {
  std::vector<Goal> goals;
  for (const PlanGoal& goal : part.goals)
    goals.push_back({.plan = &goal, .todo = make(model, goal.todo), .if_failed = make(model, goal.if_failed)});
  return goals;
}

Performer::Performer(const sim::Model& model, Demonstration demonstration, const Manner& manner)
    : m_demonstration(std::move(demonstration)),
      m_plan(m_demonstration.plan),
      m_perturbation(manner.perturbation),
      m_surgeon(model, manner.tremor) {
  for (const PlanPart& part : m_plan.parts) m_parts.push_back(make(model, part));
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
  return goal.plan->until.there() ? goal.plan->until.holds(snapshot()) == TriState::yes : goal.reached;
}

int Performer::perturbation() {
  m_since_choice = 0;
  const int choice = m_choices++;
  if (m_perturbation) return m_perturbation(choice);
  for (const Choice& made : m_demonstration.choices)
    if (made.at == choice) return made.perturbation;
  return 0;
}

/// Before a skill begins.
void Performer::choose_perturbation(Task& task) {
  const int chosen = perturbation();
  if (chosen == 0) return;
  m_surgeon.arms().tremble(perturbed_tremor(chosen));
  make_anew(m_surgeon.model(), perturbed(*task.plan, chosen), task);
}

/// While it lasts.
void Performer::go_on_otherwise() {
  if (const int chosen = perturbation(); chosen != 0) m_surgeon.arms().tremble(perturbed_tremor(chosen));
}

void Performer::choose() {
  for (; m_part < m_parts.size(); ++m_part, m_in_part = 0) {
    const auto open = [this](const Goal& g) { return !is_reached(g); };
    const auto next = std::find_if(m_parts[m_part].begin(), m_parts[m_part].end(), open);
    if (next != m_parts[m_part].end()) {
      const auto goal = size_t(next - m_parts[m_part].begin());
      m_goal = &m_parts[m_part][goal];
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
  choose_perturbation(next);
  next.skill->begin(m_surgeon, m_goal->tries - 1);
  for (Task& beside : next.meanwhile) beside.skill->begin(m_surgeon, m_goal->tries - 1);
}

void Performer::think() {
  m_pause = part().pause;
  if (m_pause == 0) choose();
}

void Performer::failed(const std::string& why) {
  Goal& goal = *m_goal;
  ++goal.failures;
  if (m_difficulties.size() < kMostDifficulties)
    m_difficulties.push_back(fmt::format("{:.1f} s: {}{}: {}", snapshot().now(), goal.plan->name,
                                         goal.plan->element.empty() ? "" : " (" + goal.plan->element + ")", why));
  if (goal.plan->tries > 0 && goal.failures >= goal.plan->tries) {
    goal.given_up = true;
    m_gave_up = m_gave_up || !goal.plan->optional;
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
  if (!is_reached(*m_goal)) return failed("all skills ended, but the goal is not reached");
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
  m_since_choice += passed;
  if (m_since_choice >= kChoiceEvery) go_on_otherwise();
  if (m_in_task > task.plan->at_most) {
    const bool goes_on = task.plan->goes_on;
    ended(goes_on ? Progress::done : Progress::failed, tr("{}: timed out", task.plan->kind->name));
    if (goes_on && m_pause > 0) {  // who has lost patience thinks no more
      m_pause = 0;
      choose();
    }
    return go_on(0);  // in the same tick
  }
  for (Task& beside : task.meanwhile) beside.skill->tick(m_surgeon, passed);
  Progress how = task.skill->tick(m_surgeon, passed);
  if (how == Progress::working && task.plan->until.there() && task.plan->until.holds(snapshot()) == TriState::yes)
    how = Progress::done;
  if (how != Progress::working) ended(how, fmt::format("{}: {}", task.plan->kind->name, task.skill->why()));
}

sim::Input Performer::next(const sim::Model& model, const sim::State& state) {
  m_surgeon.begin_tick(model, state);
  if (!m_begun) {
    m_begun = true;
    choose();
  }
  m_in_part += sim::kTick;
  if (!m_done && m_in_part > part().at_most) stop(true);
  if (!m_done) go_on(sim::kTick);
  return m_surgeon.end_tick();
}

void Performer::after(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  const Snapshot now{model, state};
  if (FactWatches* watches = m_demonstration.watches.get()) {
    watches->tick(now, report);
    if (state.tick % kSampleEvery == 0) watches->sample(now, kSample);
  }
  if (m_demonstration.judge) m_demonstration.judge->update(model, state, report);
}

}  // namespace trocar::training
