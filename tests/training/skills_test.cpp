// Skills on a small scene, and how a plan is worked through.
#include <algorithm>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/expert/performer.hpp>
#include <trocar/training/expert/plan_reader.hpp>
#include <trocar/training/observe/marks.hpp>

#include "../sim/small_scene.hpp"
#include "flaws.hpp"

namespace trocar::training {
namespace {

using small::kApplier, small::kGrasper, small::kScissors, small::kTube;

PlanTask task(const SkillKind& kind, int hand = -1) {
  PlanTask t = PlanTask::of(kind);
  if (hand >= 0) t.set_index("hand", hand);
  return t;
}
PlanTask at_tube(const SkillKind& kind, int hand, double s) {
  return task(kind, hand).set_index("of", kTube).set("at_mm", s);
}
PlanGoal goal(std::string name, std::vector<PlanTask> todo) {
  PlanGoal g;
  g.name = std::move(name);
  g.todo = std::move(todo);
  return g;
}
Demonstration plan_of(std::vector<PlanGoal> goals) {
  Demonstration d;
  d.plan.parts.emplace_back();
  d.plan.parts[0].goals = std::move(goals);
  return d;
}

/// A plan performed on the small scene.
struct Performance {
  const sim::Model& model;
  sim::State state;
  Performer performer;
  std::vector<std::string> told;  ///< what it did, in its order

  explicit Performance(Demonstration d, const sim::Model& m = small::bare(), int most = 60000)
      : model(m), state(sim::initial_state(m)), performer(m, std::move(d)) {
    sim::Work work = sim::make_work(m);
    while (!performer.done() && int(state.tick) < most) {
      const sim::Input input = performer.next(m, state);
      if (told.empty() || told.back() != performer.doing()) told.emplace_back(performer.doing());
      performer.after(m, state, step(m, input, state, work));
    }
  }
  std::string difficulties() const {
    std::string all;
    for (const std::string& d : performer.difficulties()) all += d + "\n";
    return all;
  }
};

PlanTask lift() {
  PlanTask t = at_tube(kLift, kGrasper, 0.021);
  t.set_index("across", kApplier).set("pull_N", 0.1, 2).set("straightness", 0.5).set("outwards_from_mm", 0.016);
  t.goes_on = true;
  t.at_most = 4;
  return t;
}
PlanGoal present() {
  return goal("present", {at_tube(kApproach, kGrasper, 0.056), task(kEnter, kGrasper), task(kGrasp, kGrasper), lift()});
}

TEST(Skills, AreListedOnceEachAndSayWhatTheyMean) {
  std::set<std::string_view> names;
  for (const SkillKind* kind : skills()) {
    EXPECT_TRUE(names.insert(kind->name).second) << kind->name;
    EXPECT_EQ(find_skill(kind->name), kind);
    EXPECT_FALSE(kind->doing.empty()) << kind->name;
    EXPECT_EQ(kind->meaning.back(), '.') << kind->name;
    EXPECT_GT(kind->patience, 0) << kind->name;
    std::set<std::string_view> parameters;
    for (const Parameter& p : kind->parameters) {
      EXPECT_TRUE(parameters.insert(p.name).second) << kind->name << " " << p.name;
      EXPECT_FALSE(p.meaning.empty()) << kind->name << " " << p.name;
      for (const char* word : {"skill", "at_most_s", "if_late", "until", "meanwhile"}) EXPECT_NE(p.name, word);
    }
  }
  EXPECT_EQ(find_skill("juggle"), nullptr);
}

/// Parameters of places stand once, in a section of their own; lines of the page are broken.
TEST(Skills, AreOnTheirPageWithAllTheirParameters) {
  std::ifstream in(TROCAR_SOURCE_DIR "/docs/reference/skills.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  const std::size_t places_at = page.find("## Places\n");
  ASSERT_NE(places_at, std::string::npos);
  const std::string places = page.substr(places_at, page.find("## ", places_at + 3) - places_at);
  for (const SkillKind* kind : skills()) {
    const std::size_t begin = page.find("### " + std::string(kind->name) + "\n");
    ASSERT_NE(begin, std::string::npos) << kind->name;
    const std::string section = page.substr(begin, page.find("### ", begin + 4) - begin);
    std::string unbroken = section;
    std::replace(unbroken.begin(), unbroken.end(), '\n', ' ');
    EXPECT_NE(unbroken.find(kind->meaning), std::string::npos) << kind->name;
    const bool has_place = section.find("[place](#places)") != std::string::npos;
    for (const Parameter& p : kind->parameters) {
      const std::string cell = "| `" + std::string(p.name) + "`";
      const bool of_place = has_place && places.find(cell) != std::string::npos;
      EXPECT_TRUE(of_place || section.find(cell) != std::string::npos) << kind->name << " " << p.name;
    }
  }
}

TEST(Skills, GraspHoldsTheTubeWhereItWasSent) {
  const Performance run(
      plan_of({goal("take", {at_tube(kApproach, kGrasper, 0.056), task(kEnter, kGrasper), task(kGrasp, kGrasper)})}));
  EXPECT_TRUE(run.performer.done());
  EXPECT_EQ(run.difficulties(), "");
  EXPECT_NEAR(held_arc(run.model, run.state, kGrasper, kTube), 0.056, 0.004);
}

TEST(Skills, APlaceMayBeCountedFromAStrandsEnd) {
  const double from_end = 0.02, length = small::bare().strand_bodies[kTube].length();
  const auto taken_at = [](PlanTask approach) {
    const Performance run(plan_of({goal("take", {approach, task(kEnter, kGrasper), task(kGrasp, kGrasper)})}));
    return held_arc(run.model, run.state, kGrasper, kTube);
  };
  const double there = taken_at(task(kApproach, kGrasper).set_index("of", kTube).set("from_end_mm", from_end));
  EXPECT_NEAR(there, length - from_end, 0.004);
  EXPECT_EQ(there, taken_at(at_tube(kApproach, kGrasper, length - from_end)));
}

TEST(Skills, GraspSaysThatTheJawsAreEmpty) {
  PlanGoal take = goal("take", {at_tube(kApproach, kGrasper, 0.056), task(kGrasp, kGrasper)});
  take.tries = 2;
  const Performance run(plan_of({take}));
  EXPECT_TRUE(run.performer.gave_up());
  ASSERT_EQ(run.performer.difficulties().size(), 2u);
  EXPECT_NE(run.difficulties().find("take: grasp: the jaws did not grasp it"), std::string::npos) << run.difficulties();
}

TEST(Skills, WhatIsLiftedStaysUpWhileClipsAreSet) {
  PlanTask clip = task(kClipAt, kApplier).set_index("of", kTube).set("seen", "whatever");
  PlanTask second = clip;
  clip.set("within_mm", 0.014, 0.018);
  second.set("within_mm", 0.020, 0.032).set("apart_mm", 0.009, 0.011).set("cover", 0);
  clip.set("cover", 0);
  const Performance run(plan_of({present(), goal("clips", {clip, second})}));
  EXPECT_EQ(run.difficulties(), "");
  ASSERT_EQ(run.state.clip_count, 2);
  EXPECT_EQ(run.state.clips[0].strand, kTube);
  EXPECT_NEAR(run.state.clips[0].s, 0.016, 0.002);
  EXPECT_GT(run.state.clips[0].closing_time, 1);
  EXPECT_GT(held_arc(run.model, run.state, kGrasper, kTube), 0) << "the grasper holds on";
}

TEST(Skills, AClipClosesAsFastAsItIsTold) {
  PlanTask clip = at_tube(kClipAt, kApplier, 0.02).set("seen", "whatever").set("cover", 0).set("closing_s", 0.6);
  const Performance run(plan_of({goal("clip", {clip})}));
  ASSERT_EQ(run.state.clip_count, 1);
  EXPECT_LT(run.state.clips[0].closing_time, 0.5);
}

TEST(Skills, CutGoesBetweenTheClips) {
  PlanTask cut = task(kCutAt, kScissors).set_index("of", kTube).set("at_mm", 0.024);
  const Performance run(plan_of({present(), goal("cut", {cut})}));
  ASSERT_GT(run.state.cut_count, 0) << run.difficulties();
  EXPECT_EQ(run.state.cuts[0].strand, kTube);
  EXPECT_NEAR(run.state.cuts[0].s, 0.024, 0.003);
}

/// The tube raised off the pad by that much, then cut where the pad lies behind it.
Performance cut_above_the_pad(double raised) {
  PlanTask up = task(kDraw, kGrasper).set("towards", "up").set("by_mm", raised);
  PlanTask cut = at_tube(kCutAt, kScissors, 0.049).set("inside_share", 0.6);
  const PlanGoal raise =
      goal("raise", {at_tube(kApproach, kGrasper, 0.056), task(kEnter, kGrasper), task(kGrasp, kGrasper), up});
  return Performance(plan_of({raise, goal("cut", {cut})}), small::bare(), 12000);
}

TEST(Skills, CutTakesTheStrandNearerToTheTipsWhereAnOrganLiesBehind) {
  const Performance run = cut_above_the_pad(0.011);
  EXPECT_EQ(run.difficulties(), "");
  ASSERT_EQ(run.state.cut_count, 1);
  EXPECT_EQ(run.state.cuts[0].strand, kTube);
  EXPECT_GE(run.state.cuts[0].fraction, interactions::kThrough);
  EXPECT_LT(run.state.cuts[0].beyond, 0.0038) << "they would reach 4.4 mm past it where it was wanted";
}

TEST(Skills, CutIsGivenUpWhereTheBladesCannotSpareAnOrgan) {
  const Performance run = cut_above_the_pad(0);
  EXPECT_EQ(run.state.cut_count, 0);
  EXPECT_NE(run.difficulties().find("an organ lies between the blades"), std::string::npos) << run.difficulties();
}

TEST(Skills, EaseFollowsWhatPullsUntilItHardlyDoes) {
  const std::vector<PlanTask> take{at_tube(kApproach, kGrasper, 0.056), task(kEnter, kGrasper), task(kGrasp, kGrasper),
                                   task(kDraw, kGrasper).set("towards", "head").set("by_mm", 0.02)};
  const Performance drawn(plan_of({goal("draw", take)}));
  ASSERT_GT(norm(drawn.state.tools[kGrasper].pull), 0.4) << drawn.difficulties();
  const Performance eased(plan_of({goal("draw", take), goal("ease", {task(kEase, kGrasper).set("pull_N", 0.2)})}));
  EXPECT_EQ(eased.difficulties(), "");
  EXPECT_GT(held_arc(eased.model, eased.state, kGrasper, kTube), 0) << "it holds on";
  EXPECT_LT(norm(eased.state.tools[kGrasper].pull), 0.25);
}

TEST(Skills, WithdrawStopsAtItsDepth) {
  const Performance run(plan_of({goal("back", {task(kWithdraw, kGrasper).set("to_mm", 0.03).set("pace", "brisk")})}));
  EXPECT_EQ(run.difficulties(), "");
  EXPECT_NEAR(run.state.tools[kGrasper].depth, 0.03, 0.002);
}

TEST(Skills, SweepPushesTheTubeAside) {
  const auto away = [](const char* towards) {
    PlanTask push = at_tube(kSweep, kGrasper, 0.06).set("by_mm", 0.012).set("towards", towards);
    const Performance run(plan_of({goal("push", {push})}));
    EXPECT_EQ(run.difficulties(), "");
    EXPECT_GT(run.state.tools[kGrasper].handle, 0.9) << "closed";
    const interactions::StrandBody& tube = run.model.strand_bodies[kTube];
    return point_at(tube, run.state.strands[kTube], interactions::place_at(tube, 0.06)).y;
  };
  EXPECT_GT(away("head"), 0.004);
  EXPECT_LT(away("feet"), -0.004);
}

TEST(Skills, ViewTurnsPostAndHeadUntilAnObliqueScopeLooksAlongTheNormal) {
  for (const double oblique : {0.0, 30.0}) {
    scene::Description d = small::description();
    d.membranes.clear();
    d.vessels.clear();
    d.fluids.reset();
    d.scope.angle = oblique * portable::pi / 180;
    const sim::Model model = scene::compile(d);
    sim::State state = sim::initial_state(model);
    Surgeon op(model, {});
    const int mark = model.target_index("pad");
    ASSERT_GE(mark, 0);
    const Vec3d at = place_of_mark(model, state, mark);
    sim::Input input;
    for (int t = 0; t < 12000; ++t, ++state.tick) {
      op.begin_tick(model, state);
      op.camera().view(at, std::nullopt, 0.05);
      input = op.end_tick();
    }
    EXPECT_TRUE(op.camera().settled());
    const kinematics::ScopeFrame f =
        kinematics::scope_frame(model.scope.port, pose_of(input.scope), model.scope.angle, double(input.scope.post));
    const Vec3d to = at - f.eye;
    EXPECT_NEAR(length(to), 0.05, 0.005) << oblique;
    EXPECT_GT(dot(normalised(to), f.forward), 0.995) << oblique << ": in the middle";
    const Vec3d up = normalised(-1 * model.gravity);
    EXPECT_NEAR(dot(up, f.right), 0, 0.03) << oblique << ": level";
    EXPECT_GT(dot(up, f.up), 0);
  }
}

/// A task that takes some ticks, writes its name down, and then has failed or not.
PlanTask act(std::vector<std::string>& log, const std::string& name, std::vector<bool> comes_off = {true},
             int ticks = 3) {
  PlanTask t = PlanTask::of(kHold);
  const auto times = std::make_shared<size_t>(0);
  t.wrap = [&log, name, comes_off, ticks, times](std::unique_ptr<Skill>) {
    return std::make_unique<flaws::Antic>([&log, name, comes_off, ticks, times](Surgeon&, double now) {
      if (now < (ticks - 0.5) * sim::kTick) return Progress::working;
      log.push_back(name);
      const bool well = comes_off[std::min((*times)++, comes_off.size() - 1)];
      return well ? Progress::done : Progress::failed;
    });
  };
  return t;
}
using Log = std::vector<std::string>;

TEST(Plans, GoalsComeInTheirOrderAndAFailedOneAgain) {
  Log log;
  const Performance run(
      plan_of({goal("a", {act(log, "a1"), act(log, "a2", {false, true})}), goal("b", {act(log, "b")})}));
  EXPECT_EQ(log, (Log{"a1", "a2", "a1", "a2", "b"}));
  EXPECT_FALSE(run.performer.gave_up());
  EXPECT_EQ(run.state.tick, 15u) << "no tick between tasks unless the part says so";
}

TEST(Plans, APartMayPauseBetweenGoalsAndElements) {
  Log log;
  Demonstration d = plan_of({goal("a", {act(log, "a")}), goal("b", {act(log, "b")})});
  d.plan.parts[0].pause = 2;
  d.plan.parts.push_back(d.plan.parts[0]);
  const Performance run(std::move(d));
  EXPECT_EQ(log, (Log{"a", "b", "a", "b"}));
  EXPECT_EQ(run.state.tick, 4u * 3u + 2u + 2u + 2u + 2u + 2u) << "after every goal, and before the next element";
}

TEST(Plans, AGoalIsGivenUpAfterItsTriesAndTheNextIsWorkedOn) {
  Log log;
  PlanGoal a = goal("a", {act(log, "a", {false})});
  a.tries = 3;
  const Performance run(plan_of({a, goal("b", {act(log, "b")})}));
  EXPECT_EQ(log, (Log{"a", "a", "a", "b"}));
  EXPECT_TRUE(run.performer.gave_up());
  EXPECT_EQ(run.performer.difficulties().size(), 3u);
}

TEST(Plans, SomethingElseIsDoneAfterEverySecondFailure) {
  Log log;
  PlanGoal a = goal("a", {act(log, "a", {false, false, false, false, true})});
  a.every = 2;
  a.if_failed = {act(log, "repair", {false}), act(log, "and so on")};
  const Performance run(plan_of({a}));
  EXPECT_EQ(log, (Log{"a", "a", "repair", "and so on", "a", "a", "repair", "and so on", "a"}));
}

TEST(Plans, ASkillThatTakesTooLongHasFailedUnlessItGoesOn) {
  Log log;
  PlanTask slow = act(log, "slow", {true}, 1000);
  slow.at_most = 0.1;
  PlanTask patient = slow;
  patient.goes_on = true;
  PlanGoal a = goal("a", {slow});
  a.tries = 1;
  const Performance run(plan_of({a, goal("b", {patient, act(log, "b")})}));
  EXPECT_EQ(log, (Log{"b"}));
  EXPECT_NE(run.difficulties().find("a: hold: timed out"), std::string::npos) << run.difficulties();
}

TEST(Plans, WhatGoesOnMeanwhileEndsWithItsTask) {
  Log log;
  PlanTask main = act(log, "main", {true}, 5);
  main.meanwhile = {act(log, "beside", {true}, 2)};
  main.meanwhile[0].at_most = 1;
  const Performance run(plan_of({goal("a", {main})}));
  EXPECT_EQ(log.back(), "main");
  EXPECT_EQ(std::count(log.begin(), log.end(), "beside"), 4) << "ticks 2 to 5";
}

TEST(Plans, APartThatTakesTooLongEndsAll) {
  Log log;
  Demonstration d = plan_of({goal("a", {act(log, "a", {true}, 1000)})});
  d.plan.parts[0].at_most = 0.2;
  const Performance run(std::move(d));
  EXPECT_TRUE(run.performer.gave_up());
  EXPECT_TRUE(log.empty());
  EXPECT_NEAR(double(run.state.tick), 201, 1);
}

// Read from a file

struct ReadPlan {
  Faults faults;
  FactWatches watches;
  Plan plan;
  scene::JsonDocument document;

  explicit ReadPlan(const std::string& text, const sim::Model* model = &small::bare()) {
    document = scene::parse_json(text, "plan.json", faults);
    static const std::string file = "plan.json";
    Limits limits(1);
    limits[0].name = "first_mm";
    limits[0].low = 12, limits[0].high = 20;
    limits[0].is_range = true;
    const auto ends =
        scene::parse_json(R"([{"name": "near", "hand": "a"}, {"name": "far", "hand": "b"}])", file, faults);
    const Names names(limits, {read_set("end", ends.root, file, model, 0, faults)});
    RuleReading reading;
    reading.named = &names;
    reading.model = model;
    reading.facts = model ? &watches : nullptr;
    reading.file = &file;
    reading.faults = &faults;
    plan = read_plan(document.root, reading);
  }
  std::string all() const {
    std::string text;
    for (const core::Fault& f : faults)
      text += std::to_string(f.at.line) + ":" + std::to_string(f.at.column) + ": " + f.message + "\n";
    return text;
  }
};

TEST(PlanFiles, SayForEachElementWhoDoesWhat) {
  const ReadPlan read(R"([
    {"goal": "wait", "tries": 2, "do": [{"skill": "hold", "for_s": 0.5}]},
    {"for_each": "end", "at_most_s": 60, "pause_s": 0.001, "goals": [
      {"goal": "{name}", "until": {"fact": "hand.has", "hand": "$end.hand", "kind": "scissors"}, "every": 3,
       "do": [{"skill": "clip_at", "hand": "c", "of": "tube", "within_mm": "$first_mm", "at_most_s": 9, "if_late": "go_on",
               "meanwhile": [{"skill": "withdraw", "hand": "$end.hand"}]}],
       "if_failed": [{"skill": "let_go", "hand": "$end.hand"}]}]}])");
  ASSERT_EQ(read.all(), "");
  ASSERT_EQ(read.plan.parts.size(), 3u);
  EXPECT_EQ(read.plan.parts[0].goals[0].tries, 2);
  EXPECT_EQ(read.plan.parts[1].group, read.plan.parts[2].group);
  EXPECT_EQ(read.plan.parts[2].pause, 1);
  EXPECT_EQ(read.plan.parts[2].at_most, 60);
  const PlanGoal& far = read.plan.parts[2].goals[0];
  EXPECT_EQ(far.name, "far");
  EXPECT_TRUE(far.until.there());
  EXPECT_EQ(far.every, 3);
  PlanTask clip = far.todo[0];
  EXPECT_EQ(clip.kind->name, "clip_at");
  EXPECT_EQ(clip.argument("within_mm").low, 0.012);
  EXPECT_EQ(clip.at_most, 9);
  EXPECT_TRUE(clip.goes_on);
  EXPECT_EQ(clip.meanwhile[0].argument("hand").index, 1);
}

TEST(PlanFiles, TellAllFaultsWithTheirPlaces) {
  const ReadPlan read(R"([
    {"goal": "a", "do": [{"skill": "clipat", "hand": "c"}]},
    {"goal": "b", "do": [{"skill": "clip_at", "hand": "z", "of": "tube", "at": 3}]},
    {"goal": "c", "do": [{"skill": "grasp", "hand": "a", "to": 3}]},
    {"goal": "d"},
    {"do": []},
    {"for_each": "side", "goals": []}])");
  const std::string all = read.all();
  for (const char* part : {"2:36: ", "clip_at", "3:55: ", "\"z\"", "4:64: ", "[0, 1]", "5:5: ", "6:5: ", "7:18: "})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
}

TEST(PlanFiles, SayWhatTheSceneLacksForASkill) {
  const ReadPlan read(R"([{"goal": "a", "do": [
    {"skill": "clip_at", "hand": "a", "of": "tube", "at_mm": 20},
    {"skill": "suck_dry", "hand": "a"},
    {"skill": "approach", "hand": "a", "of": "tube", "at_mm": 200},
    {"skill": "clip_vessel", "hand": "c"}]}])");
  const std::string all = read.all();
  for (const char* part : {"2:5: ", "has no clip_applier", "no fluids", "is only", "the scene has no bleeder"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
}

TEST(PlanFiles, CanBeCheckedWithoutAScene) {
  const ReadPlan read(
      R"([{"goal": "a", "do": [{"skill": "clip_at", "hand": "nobody", "of": "nothing", "closing_s": 99}]}])", nullptr);
  EXPECT_NE(read.all().find("[0.05, 60]"), std::string::npos) << read.all();
  EXPECT_EQ(read.faults.size(), 1u) << read.all();
}

}  // namespace
}  // namespace trocar::training
