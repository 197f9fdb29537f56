// Who works through a plan.
//
//   Performer performer(model, read_demonstration(exercise, model), manner);
//   while (!performer.done()) {
//     const sim::StepReport report = step(model, performer.next(model, state), state, work);
//     performer.after(model, state, report);
//   }
#pragma once

#include <trocar/training/expert/demonstration.hpp>
#include <trocar/training/expert/expert.hpp>

namespace trocar::training {

class Performer final : public Expert {
 public:
  Performer(const sim::Model& model, Demonstration demonstration, const Manner& manner = {});

  sim::Input next(const sim::Model& model, const sim::State& state) override;
  void after(const sim::Model& model, const sim::State& state, const sim::StepReport& report) override;
  bool done() const override { return m_done; }
  bool gave_up() const override { return m_gave_up; }
  std::string goal() const override { return m_goal ? m_goal->plan->name : std::string{}; }
  const char* doing() const override;
  const std::vector<std::string>& difficulties() const override { return m_difficulties; }

 private:
  struct Task {
    const PlanTask* plan;
    std::unique_ptr<Skill> skill;
    std::vector<Task> meanwhile;
  };
  struct Goal {
    const PlanGoal* plan;
    std::vector<Task> todo, if_failed;
    int tries = 0, failures = 0;
    bool reached = false, given_up = false;
  };

  static std::vector<Goal> make(const sim::Model& model, const PlanPart& part);
  static std::unique_ptr<Skill> skill_of(const sim::Model& model, const PlanTask& task);
  static Task make(const sim::Model& model, const PlanTask& task);
  static void make_anew(const sim::Model& model, const PlanTask& otherwise, Task& task);
  static std::vector<Task> make(const sim::Model& model, const std::vector<PlanTask>& tasks);

  void choose();
  int perturbation();
  void choose_perturbation(Task& task);
  void go_on_otherwise();
  bool is_reached(const Goal& goal) const;
  void begin(size_t task);
  void go_on(double passed);
  void work(double passed);
  void ended(Progress how, const std::string& why);
  void failed(const std::string& why);
  void think();
  void stop(bool gave_up);
  const PlanPart& part() const { return m_plan.parts[m_part]; }
  std::vector<Task>& tasks() { return m_repairing ? m_goal->if_failed : m_goal->todo; }
  Snapshot snapshot() const { return {m_surgeon.model(), m_surgeon.state()}; }

  Demonstration m_demonstration;
  const Plan& m_plan;
  std::function<int(int)> m_perturbation;
  Surgeon m_surgeon;
  std::vector<std::vector<Goal>> m_parts;
  size_t m_part = 0, m_task = 0;
  int m_choices = 0;          ///< decision points so far
  double m_since_choice = 0;  ///< [s]
  Goal* m_goal = nullptr;     ///< that is worked on
  bool m_repairing = false;   ///< its if_failed
  bool m_begun = false, m_done = false, m_gave_up = false;
  int m_pause = 0;                      ///< ticks left to think
  double m_in_part = 0, m_in_task = 0;  ///< [s]
  std::vector<std::string> m_difficulties;
};

}  // namespace trocar::training
