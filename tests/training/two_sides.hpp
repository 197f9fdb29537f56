// A scene with a tube on either side, small enough for tests that make up its State: an organ in the middle, two tubes
// with isthmus, ampulla and fimbria, a cord, and three hands. And an attempt in it whose State a test writes as it
// goes.
#pragma once

#include <functional>

#include <nlohmann/json.hpp>

#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/observe/hands.hpp>

#include "../sim/small_scene.hpp"
#include "changed_exercise.hpp"

namespace trocar::two_sides {

inline constexpr int kLeft = 0, kRight = 1, kCord = 2;  ///< strands
inline constexpr int kGrasper = 0, kScissors = 1, kApplier = 2;

inline scene::Strand tube(const char* name, double side) {
  scene::Strand s = small::tube();
  s.name = name;
  s.centreline.clear();
  for (double x : {0.0, 0.020, 0.040, 0.060, 0.090}) s.centreline.push_back({x, side * 0.05, 0});
  s.start = {};
  s.start.fixed = true;
  s.landmarks = {{"isthmus", 0, 0.025}, {"ampulla", 0.025, 0.075}, {"fimbria", 0.080, 0.090}};
  return s;
}

inline const sim::Model& model() {
  static const sim::Model compiled = [] {
    scene::Description d = small::description();
    d.strands = {tube("tube_left", 1), tube("tube_right", -1), small::cord()};
    d.membranes.clear();
    d.vessels.clear();  // blood is what a test says
    d.energy = scene::EnergySetting{};
    return scene::compile(d);
  }();
  return compiled;
}

/// The shipped exercise's file with the small scene's bodies in it, and whatever else a test changes.
inline training::Exercise exercise_with(const std::vector<std::pair<std::string, std::string>>& changes = {}) {
  std::vector<std::pair<std::string, std::string>> all{
      {"\"of\": \"uterus\"", "\"of\": \"organ\""},
      {"\"ovary\": \"ovary_left\"", "\"ovary\": \"pad\""},
      {"\"ovary\": \"ovary_right\"", "\"ovary\": \"pad\""},
      {"\"mesosalpinx\": \"mesosalpinx_left\"", "\"mesosalpinx\": []"},
      {"\"mesosalpinx\": \"mesosalpinx_right\"", "\"mesosalpinx\": []"},
      {R"("delicate": ["$side.tube", "ovary_left", "ovary_right", "mesosalpinx_left", "mesosalpinx_right"])",
       R"("delicate": ["$side.tube"])"},
      {R"({"name": "rectosigmoid", "title": "the bowel"}],)", R"({"name": "pad", "title": "the pad"}],)"},
      {R"({"name": "round_ligament_left", "title": "the left round ligament"})",
       R"({"name": "cord", "title": "the cord"})"}};
  all.insert(all.end(), changes.begin(), changes.end());
  return training::read_exercise(kChanged, changed_exercise("gynaecology/sterilisation.json", all));
}
inline const training::Exercise& exercise() {
  static const training::Exercise made = exercise_with();
  return made;
}

/// An attempt whose State is made up as it goes; everything is in view unless a test looks away.
struct Attempt {
  const sim::Model& model = two_sides::model();
  sim::State state = sim::initial_state(model);
  training::Monitor monitor;

  explicit Attempt(training::Mode mode = training::Mode::assessed, const training::Exercise& of = exercise())
      : monitor(of, model, mode) {
    for (std::uint8_t& seen : state.seen) seen = 1;
  }

  void tick(const sim::StepReport& report = {}) {
    ++state.tick;
    monitor.update(model, state, report);
  }
  void seconds(double s) {
    for (int i = 0; i < int(s * 1000 + 0.5); ++i) tick();
  }
  /// Blood runs into the pool. @param flow  [mL/s]
  void bleed(double flow, double s) {
    for (int i = 0; i < int(s * 1000 + 0.5); ++i) {
      const auto bled = std::int64_t(flow / 1000 * double(fluids::kMillilitre));
      receive(state.fluids.ledger, fluids::Source::kBled, fluids::Place::kPool, {.blood = bled});
      tick();
    }
  }
  /// A column of blood over the hand's tip.
  void drown(int hand) {
    const fluids::PoolModel& pool = model.wet.model.pool;
    const fluids::PoolPoint at = locate(pool, training::tip_of(model, state, size_t(hand)));
    pour(pool, at.i, at.j, {.blood = 1000 * std::int64_t(fluids::kMillilitre)}, state.fluids.pool);
  }
  /// A pedal is pressed; current flows through the body, if any.
  void press(double s, BodyId body = {}) {
    sim::ElectrodeHand& hand = state.electrodes[kGrasper];
    hand.current.now.mode = tissue::EnergyMode::coag;
    hand.current.now.flows = body.exists();
    hand.body = body;
    seconds(s);
    hand.current.now = {};
    tick();
  }
  void event(const sim::Event& event) {
    sim::StepReport report;
    report.events[0] = event;
    report.event_count = 1;
    tick(report);
  }
  /// Everything whose target's name begins so comes into view, or goes out of it.
  void look(const std::string& name, bool seen) {
    for (const sim::VisibilityTarget& t : model.targets)
      if (t.name.rfind(name, 0) == 0)
        for (int i = t.first; i < t.first + t.count; ++i) state.seen[size_t(i)] = seen;
  }
  void look_away() {
    for (std::uint8_t& seen : state.seen) seen = 0;
  }

  void hold(BodyId body, int element, double pull) {
    interactions::ToolState& grasper = state.tools[kGrasper];
    grasper.holds = 1;
    grasper.hold[0].at.body = body;
    grasper.hold[0].at.element = element;
    grasper.pull[2] = pull;
    grasper.pinch = 5;
  }
  void hold_tube(int tube, double s, double pull) {
    hold(BodyId::strand(size_t(tube)), interactions::place_at(model.strand_bodies[size_t(tube)], s).element, pull);
  }
  void let_go() {
    state.tools[kGrasper].holds = 0;
    state.tools[kGrasper].pull[2] = 0;
  }
  void survey() {
    state.tools[kGrasper].depth += 0.002;
    seconds(1.1);
  }
  void identify() { seconds(3); }
  void present(int tube) {
    hold_tube(tube, 0.055, 1.0);
    seconds(0.3);
  }
  interactions::Clip good_clip(int tube, double s) const {
    interactions::Clip c;
    c.s = s;
    c.cover = 1;
    c.closing_time = 2;
    c.tips_visible = 2;
    c.strand = tube;
    c.tool = kApplier;
    return c;
  }
  void clip(const interactions::Clip& c) {
    state.clips[size_t(state.clip_count++)] = c;
    const int number = state.clip_count - 1;
    event(c.strand < 0 ? sim::Event::recorded(sim::Event::dropped_clip, kApplier, number, {})
                       : sim::Event::recorded(sim::Event::clipped, kApplier, number, c.body()));
  }
  void both_clips(int tube) {
    clip(good_clip(tube, 0.016));
    clip(good_clip(tube, 0.025));
  }
  interactions::Cut good_cut(int tube, double s = 0.0205) const {
    interactions::Cut c;
    c.s = s;
    c.fraction = 1;
    c.beyond = 0.001;
    c.tips_visible = 1;
    c.strand = tube;
    c.tool = kScissors;
    return c;
  }
  void cut(const interactions::Cut& c) {
    if (c.strand >= 0 && c.fraction >= 0.99) {
      const interactions::StrandPlace place = interactions::place_at(model.strand_bodies[size_t(c.strand)], c.s);
      tissue::cut_element(state.strands[size_t(c.strand)], place.element);
    }
    state.cuts[size_t(state.cut_count++)] = c;
    event(sim::Event::recorded(sim::Event::cut, kScissors, state.cut_count - 1, c.body()));
  }
  void up_to_clips(int tube) {
    survey();
    identify();
    present(tube);
  }
  /// @param then  what happens before the stumps are looked at
  void one_side(int tube, const std::function<void(Attempt&)>& then = nullptr) {
    present(tube);
    both_clips(tube);
    cut(good_cut(tube));
    let_go();
    if (then) then(*this);
    seconds(2.1);
  }
  void all() {
    survey();
    identify();
    one_side(kLeft);
    one_side(kRight);
  }
  bool done(const std::string& task, const std::string& side = "left") const {
    for (const training::StepStatus& s : monitor.steps())
      if (s.task == task && (s.side == side || s.side.empty())) return s.done;
    return false;
  }
  /// What the result tells of a side.
  nlohmann::json detail(const std::string& side, const std::string& name) const {
    const nlohmann::json result = nlohmann::json::parse(monitor.result_json());
    for (const auto& d : result["details"])
      if (d["side"] == side && d.contains(name)) return d[name];
    return nullptr;
  }
  std::vector<std::string> codes() const {
    std::vector<std::string> made;
    for (const training::ErrorMade& e : monitor.errors()) made.push_back(e.code);
    return made;
  }
};

}  // namespace trocar::two_sides
