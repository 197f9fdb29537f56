#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/expert/plan.hpp>

namespace trocar::training {

PlanTask PlanTask::of(const SkillKind& kind) {
  PlanTask task;
  task.kind = &kind;
  task.arguments.resize(kind.parameters.size());
  task.at_most = kind.patience;
  return task;
}

Argument& PlanTask::argument(std::string_view name) {
  for (size_t i = 0; i < kind->parameters.size(); ++i)
    if (kind->parameters[i].name == name) return arguments[i];
  throw std::out_of_range(tr("the skill {} has no parameter {}", kind->name, name));
}

PlanTask& PlanTask::set(std::string_view name, double si) { return set(name, si, si); }

PlanTask& PlanTask::set(std::string_view name, double low, double high) {
  Argument& a = argument(name);
  a.given = true;
  a.low = low;
  a.high = high;
  return *this;
}

PlanTask& PlanTask::set(std::string_view name, const std::string& word) {
  Argument& a = argument(name);
  a.given = true;
  a.word = word;
  return *this;
}

PlanTask& PlanTask::set_index(std::string_view name, std::int32_t index) {
  Argument& a = argument(name);
  a.given = true;
  a.index = index;
  return *this;
}

PlanTask& PlanTask::unset(std::string_view name) {
  argument(name) = {};
  return *this;
}

PlanGoal& Plan::goal(std::string_view name, std::string_view element) {
  for (PlanPart& part : parts)
    for (PlanGoal& goal : part.goals)
      if (goal.name == name && (element.empty() || part.element == element)) return goal;
  throw std::out_of_range(tr("the plan has no goal {}", name));
}

PlanTask& Plan::task(std::string_view goal_name, std::string_view skill, std::string_view element) {
  for (PlanTask& task : goal(goal_name, element).todo)
    if (task.kind->name == skill) return task;
  throw std::out_of_range(tr("the goal {} has no task {}", goal_name, skill));
}

namespace {

void visit_all(std::vector<PlanTask>& tasks, const std::function<void(PlanTask&)>& visit) {
  for (PlanTask& task : tasks) {
    visit(task);
    visit_all(task.meanwhile, visit);
  }
}

void check_tasks(const std::vector<PlanTask>& tasks, const sim::Model& model, Faults& faults) {
  for (const PlanTask& task : tasks) {
    const std::string lack = task.kind->lacks(model, SkillArgs(*task.kind, task.arguments));
    if (!lack.empty())
      scene::tell(faults,
                  {task.at, tr("expected a scene that suits the skill \"{}\", got: {}", task.kind->name, lack)});
    check_tasks(task.meanwhile, model, faults);
  }
}

}  // namespace

void Plan::each_task(const std::function<void(PlanTask&)>& visit) {
  for (PlanPart& part : parts)
    for (PlanGoal& goal : part.goals) {
      visit_all(goal.todo, visit);
      visit_all(goal.if_failed, visit);
    }
}

void check_plan(const Plan& plan, const sim::Model& model, Faults& faults) {
  for (const PlanPart& part : plan.parts)
    for (const PlanGoal& goal : part.goals) {
      check_tasks(goal.todo, model, faults);
      check_tasks(goal.if_failed, model, faults);
    }
}

}  // namespace trocar::training
