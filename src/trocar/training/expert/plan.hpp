// A plan: what a demonstration works through. It is read from an exercise's file (plan_reader.hpp) or built by hand,
// and can be changed before anybody performs it: tests make mistakes of parameters, wrap skills and insert others.
//
//   plan.task("first clip", "clip_at").set("closing_s", 0.6);
//   plan.goal("first clip").todo.insert(...);
//
// From the top, the first goal that is not reached and not given up is worked on; when its tasks have ended, or one has
// failed, again from the top. Parts come one after the other: what a part has reached, later ones do not look at again.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <trocar/training/rules/condition.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {

/// One use of a skill.
struct PlanTask {
  const SkillKind* kind = nullptr;
  Arguments arguments;              ///< in the order of its kind's parameters
  double at_most = 0;               ///< [s]
  bool goes_on = false;             ///< a skill that took longer has not failed
  Condition until;                  ///< it ends when this is so
  std::vector<PlanTask> meanwhile;  ///< continue beside it, whatever becomes of them
  core::Location at;                ///< in the file
  /// Who does it instead, made of who would; null: who would.
  std::function<std::unique_ptr<Skill>(std::unique_ptr<Skill>)> wrap;

  static PlanTask of(const SkillKind& kind);
  /// A parameter of this name; a hand, a mark ... by its number, numbers in SI. Throws std::out_of_range: there is
  /// none.
  Argument& argument(std::string_view name);
  PlanTask& set(std::string_view name, double si);
  PlanTask& set(std::string_view name, double low, double high);
  PlanTask& set(std::string_view name, const std::string& word);
  PlanTask& set_index(std::string_view name, std::int32_t index);
  PlanTask& unset(std::string_view name);
};

struct PlanGoal {
  std::string name;
  std::string element;    ///< of the set that its part is there for each of
  Condition until;        ///< reached when this is so; not there: when its tasks have ended well once
  int tries = 0;          ///< after as many failures it is given up; 0: never
  bool optional = false;  ///< who gives it up has not given up the whole
  std::vector<PlanTask> todo;
  std::vector<PlanTask> if_failed;  ///< before it is tried again
  int every = 1;                    ///< after so many failures each
  core::Location at;
};

struct PlanPart {
  std::string element;
  int group = 0;         ///< parts that are there for each of one set have the same
  double at_most = 1e9;  ///< longer, and the whole plan is given up [s]
  int pause = 0;         ///< ticks between goals, and between the elements of a set
  std::vector<PlanGoal> goals;
};

struct Plan {
  std::vector<PlanPart> parts;

  /// The first of that name, of that element where one is named. Throws std::out_of_range: there is none.
  PlanGoal& goal(std::string_view name, std::string_view element = {});
  PlanTask& task(std::string_view goal, std::string_view skill, std::string_view element = {});
  /// Calls visit(task) for every one, wherever it stands.
  void each_task(const std::function<void(PlanTask&)>& visit);
};

/// What the scene lacks for the plan's skills: nothing of it is simulated.
void check_plan(const Plan& plan, const sim::Model& model, Faults& faults);

}  // namespace trocar::training
