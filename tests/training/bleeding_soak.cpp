// Bleeding control as its file demonstrates it, at each of its places: clipped, or coagulated where the artery is
// small, under blood once that is sucked away, it stops for good; with the first clip on the wrong side it bleeds on,
// and fails with its code. One run a code, with that flaw in the plan.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>

#include "flaws.hpp"

namespace trocar::training {
namespace {

/// Some of the scene's holes by number.
enum Place { kWide = 0, kNearWall = 2, kSmall = 3, kSmallDeep = 4, kPlaces = 6 };

sim::Model bleeding_at(const Exercise& exercise, int place) {
  scene::Description scene = scene::read_scene(exercise.scene);
  scene.bleeder->which = place;
  return scene::compile(scene);
}

/// Blood that has left vessels since the start [m^3].
double lost(const sim::Model& model, const sim::State& state) {
  return fluids::kM3PerPicolitre *
         double(state.fluids.ledger.in[size_t(fluids::Source::kBled)].blood - model.wet.pool_at_start.blood);
}

/// What of the plan is done wrongly.
using Spoil = std::function<void(const sim::Model&, Plan&)>;

struct Attempt {
  Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/bleeding-control.json");
  sim::Model model;
  Monitor monitor;
  sim::State state = sim::initial_state(model);
  int tears = 0;
  double flow = 0;  ///< in the last second [m^3/s]

  /// @param place  number of the hole that opens
  explicit Attempt(const Spoil& spoil, int place = kWide)
      : model(bleeding_at(exercise, place)), monitor(exercise, model) {
    Demonstration demonstration = read_demonstration(exercise, model);
    if (spoil) spoil(model, demonstration.plan);
    Performer surgeon(model, std::move(demonstration));
    sim::Work work = sim::make_work(model);
    std::vector<double> second(1000, 0);
    while (!surgeon.done() && state.tick < 600'000) {
      const sim::Input input = surgeon.next(model, state);
      const sim::StepReport report = step(model, input, state, work);
      EXPECT_TRUE(report.fine());
      for (int i = 0; i < report.event_count; ++i) tears += report.events[i].kind == sim::Event::torn;
      surgeon.after(model, state, report);
      monitor.update(model, state, report);
      flow = lost(model, state) - std::exchange(second[state.tick % 1000], lost(model, state));
    }
  }
  int clips() const { return state.clip_count; }
  bool made(const std::string& code) const {
    return std::any_of(monitor.errors().begin(), monitor.errors().end(),
                       [&code](const ErrorMade& e) { return e.code == code; });
  }
};

class BleedingPlace : public testing::TestWithParam<int> {};

TEST_P(BleedingPlace, TheDemonstrationStopsItAndPasses) {
  const Attempt a({}, GetParam());
  std::printf("place %d: %.0f points after %.1f s, %.1f mL lost, %d clips\n", GetParam(), a.monitor.score().total,
              sim::kTick * double(a.state.tick), 1e6 * lost(a.model, a.state), a.clips());
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_TRUE(a.monitor.score().passed);
  EXPECT_GE(a.monitor.score().total, 90);
  for (const ErrorMade& e : a.monitor.errors()) ADD_FAILURE() << e.code << " at " << e.at << " s";
  EXPECT_EQ(a.clips() == 0, GetParam() == kSmall || GetParam() == kSmallDeep) << "small arteries are coagulated";
  EXPECT_EQ(a.flow, 0) << "to the picolitre";
  EXPECT_LT(lost(a.model, a.state), 10e-6);
  EXPECT_TRUE(balanced(a.state.fluids.ledger));
  EXPECT_EQ(a.tears, 0) << "also after the last step, while it sucks";
}

INSTANTIATE_TEST_SUITE_P(All, BleedingPlace, testing::Range(0, int(kPlaces)));

/// The first clip on the heart's side, to be set wrongly; then it is set rightly.
PlanTask& upstream(Plan& plan) { return flaws::first_wrongly(plan, "clip on the proximal side").todo[0]; }
int applier(Plan& plan) { return plan.task("clip on the proximal side", "clip_vessel").argument("hand").index; }
PlanTask& first_look(Plan& plan) { return plan.task("watch the bleeding", "wait_for_blood"); }

void forget(Plan& plan, std::string_view goal) {
  for (PlanPart& part : plan.parts)
    part.goals.erase(
        std::remove_if(part.goals.begin(), part.goals.end(), [goal](const PlanGoal& g) { return g.name == goal; }),
        part.goals.end());
}

/// No hand moves while the camera looks at the end: what is still judged then would be told as moved out of view.
void keep_hands_still_at_the_end(Plan& plan) { plan.task("check that it stays dry", "inspect").meanwhile.clear(); }

void leave_the_pool(Plan& plan) {
  forget(plan, "clear the pool");
  keep_hands_still_at_the_end(plan);
}

/// Looks on until so much has run out, or for so long. The pool is left: who clears so large a one has to go at it
/// twice, and moves out of view meanwhile (E4.1).
void wait(Plan& plan, double volume, double seconds = 0) {
  leave_the_pool(plan);
  flaws::replace(first_look(plan), [volume, seconds](Surgeon& op, double now) {
    return lost(op.model(), op.state()) > volume && now > seconds ? Progress::done : Progress::working;
  });
  first_look(plan).at_most = 600;
}

/// Takes the hook before anything bleeds and burns with it.
void burn(Plan& plan, std::vector<PlanTask> where) {
  keep_hands_still_at_the_end(plan);
  PlanGoal& first = plan.goal("watch the bleeding");
  PlanGoal& later = plan.goal("clear the pool");
  std::vector<PlanTask> all;
  for (PlanTask& task : later.todo) {
    if (task.kind != &kPutDown && task.kind != &kTake) continue;
    all.push_back(task);
    if (task.kind == &kTake) all.back().set("instrument", "hook").set("there", "bleeding");
  }
  for (PlanTask& task : where) {
    if (task.kind == &kCoagulate) task.set_index("hand", all.front().argument("hand").index);
    task.goes_on = true;
    all.push_back(task);
  }
  first.todo.insert(first.todo.begin(), all.begin(), all.end());
}

/// Coagulates what is too wide for that, then clips it.
void coagulate_first(Plan& plan) {
  PlanGoal& goal = plan.goal("coagulate");
  goal.until = {};
  goal.tries = 2;
}

PlanTask burn_at_bleeding(double seconds) {
  return PlanTask::of(kCoagulate).set("there", "bleeding").set("for_s", seconds);
}
int other_tube(const sim::Model& model) {
  const std::string& name = model.vessels.list[size_t(model.vessels.bleeder.vessel)].name;
  return model.strand_index(name.find("left") != std::string::npos ? "tube_left" : "tube_right");
}
PlanTask burn_at_tube(const sim::Model& model, double seconds) {
  const double s = 0.35 * model.strand_bodies[size_t(other_tube(model))].length();
  return PlanTask::of(kCoagulate).set_index("of", other_tube(model)).set("at_mm", s).set("for_s", seconds);
}

struct Case {
  const char* code;
  Spoil spoil;
  int place = kWide;
};
void PrintTo(const Case& c, std::ostream* os) { *os << c.code; }

const Case kCases[] = {
    {"E4.2", [](const sim::Model&, Plan& p) { upstream(p).set("look", "away").set("seen", "whatever"); }},
    {"E6",
     [](const sim::Model&, Plan& p) {
       PlanTask air = burn_at_bleeding(1);
       burn(p, {air});
       for (PlanTask& task : p.goal("watch the bleeding").todo)
         if (task.kind == &kCoagulate) {
           const int hand = task.argument("hand").index;
           flaws::replace(task, [hand](Surgeon& op, double now) {
             Arms::Arm& arm = op.arm(hand);
             op.want(arm.tip);
             const bool there = op.arms().move_to_depth(hand, 0.07, pace::kCareful);
             arm.coagulating = there && now < 4;
             return now > 4 ? Progress::done : Progress::working;
           });
         }
     }},
    {"E7", [](const sim::Model& m, Plan& p) { burn(p, {burn_at_tube(m, 1)}); }},
    {"E7.1",
     [](const sim::Model& m, Plan& p) {
       burn(p, {PlanTask::of(kCoagulate).set_index("nearest_of", m.target_index("rectosigmoid")).set("for_s", 1)});
     }},
    {"E7.2",
     [](const sim::Model& m, Plan& p) {
       burn(p, {burn_at_bleeding(2), burn_at_tube(m, 0)});
     },
     kNearWall},
    {"E8",
     [](const sim::Model&, Plan& p) {
       burn(p, {burn_at_bleeding(8)});
       leave_the_pool(p);
     }},
    {"E9.1", [](const sim::Model&, Plan& p) { wait(p, 10.5e-6); }},
    {"E9.2", [](const sim::Model&, Plan& p) { wait(p, 52.5e-6); }},
    {"E9.3", [](const sim::Model&, Plan& p) { wait(p, 0, 68); }},
    {"E10",
     [](const sim::Model&, Plan& p) {
       leave_the_pool(p);
       p.task("check that it stays dry", "inspect").set("for_s", 70).at_most = 100;
     }},
    {"E12",
     [](const sim::Model& m, Plan& p) {
       const interactions::ToolModel& t = m.hands[size_t(applier(p))].rack[0];
       upstream(p).set("inside_mm", t.jaw_length - t.clip_length + 0.0165).set("seen", "whatever");
     }},
    {"A3.1",
     [](const sim::Model&, Plan& p) {
       forget(p, "clip on the proximal side");
       leave_the_pool(p);
       p.goal("clip beyond").tries = 1;
     },
     kNearWall},  // near the ovary the tube hides the legs beyond the place
    {"A3.2",
     [](const sim::Model& m, Plan& p) {
       PlanTask wrong = PlanTask::of(kClipAt);
       wrong.set_index("hand", applier(p)).set_index("of", other_tube(m));
       wrong.set("at_mm", 0.35 * m.strand_bodies[size_t(other_tube(m))].length()).set("seen", "whatever");
       wrong.set("cover", 0).set("angle_deg", 0, 1.5);
       flaws::insert(p.goal("clip on the proximal side"), 0, wrong);
     }},
    {"A3.3",
     [](const sim::Model& m, Plan& p) {
       const interactions::ToolModel& t = m.hands[size_t(applier(p))].rack[0];
       upstream(p).set("inside_mm", t.jaw_length - 0.0002).set("seen", "whatever");
     }},
    {"A3.4", [](const sim::Model&, Plan& p) { upstream(p).set("closing_s", 1.04); }},
    {"A3.5", [](const sim::Model&, Plan& p) { coagulate_first(p); }},
};

TEST(BleedingControl, WithTheFirstClipOnTheWrongSideItBleedsOnAndFails) {
  const Case* wrong =
      std::find_if(std::begin(kCases), std::end(kCases), [](const Case& c) { return std::string(c.code) == "A3.1"; });
  const Attempt a(wrong->spoil, wrong->place);
  EXPECT_TRUE(a.made("A3.1"));
  EXPECT_FALSE(a.monitor.score().passed);
  EXPECT_GT(60e6 * a.flow, 5) << "[mL/min]";
}

/// What needs blood, fluids or energy, one run a code.
class BleedingFlaw : public testing::TestWithParam<Case> {};

bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

TEST_P(BleedingFlaw, TriggersItsErrorAndOnlyWhatTheTableSaysItImplies) {
  const Attempt a(GetParam().spoil, GetParam().place);
  const std::string code = GetParam().code;
  const Penalty& p = *a.exercise.penalty(code);
  for (const ErrorMade& e : a.monitor.errors()) {
    std::printf("%s: %s at %.1f s\n", code.c_str(), e.code.c_str(), e.at);
    EXPECT_TRUE(e.code == code || has(p.implies, e.code) || has(p.may, e.code))
        << e.code << " at " << e.at << " s is not in the table for " << code;
  }
  EXPECT_TRUE(a.made(code));
  for (const std::string& implied : p.implies) EXPECT_TRUE(a.made(implied)) << implied;
  EXPECT_EQ(a.monitor.score().failed, p.fail);
}
INSTANTIATE_TEST_SUITE_P(Codes, BleedingFlaw, testing::ValuesIn(kCases), [](const auto& of) {
  std::string name = of.param.code;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

}  // namespace
}  // namespace trocar::training
