// Slings in the step: a loop is fed out, put over a strand, drawn closed, cut off, and obeys the laws of the step.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_sling_step.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;
using interactions::SlingState;
using interactions::Suture;

namespace {

constexpr int kRight = 1;

const Model& box() {
  static const Model made = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_loop/scene.json"));
  return made;
}

struct Looped : small::Table {
  Vec3d tip;
  std::vector<Event> told;
  explicit Looped(const Model& of = box()) : Table(of) {
    tip = kinematics::forward(model.hands[kRight].port, pose_of(input.tools[kRight])).tip;
    input.tools[kRight].handle = 1;
  }
  const interactions::SutureState& suture() const { return interactions::part_of<Suture>(state.objects)[0]; }
  const SlingState& sling() const { return suture().sling; }

  void tick() {
    const StepReport r = sim::step(model, input, state, work);
    for (int i = 0; i < r.event_count; ++i) told.push_back(r.events[i]);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  bool was_told(Event::Kind kind) const {
    return std::any_of(told.begin(), told.end(), [kind](const Event& e) { return e.kind == kind; });
  }
  void hold(Vec3d to) {
    kinematics::FulcrumPose pose = kinematics::inverse(model.hands[kRight].port, to, 0);
    // the loop's plane contains the tube and what is level: its normal as upright as can be
    pose.roll = kinematics::roll_towards(pose, {0, 1, 0});
    const float handle = input.tools[kRight].handle;
    input.tools[kRight] = tool_input(pose, handle);
    tip = to;
  }
  void move(Vec3d to, double speed) {
    const Vec3d from = tip;
    const int n = std::max(1, int(length(to - from) / (speed * kTick)));
    for (int i = 1; i <= n; ++i) hold(from + double(i) / n * (to - from)), tick();
  }
  void handle(double to, int n) {
    const double from = input.tools[kRight].handle;
    for (int i = 1; i <= n; ++i) input.tools[kRight].handle = float(from + (to - from) * i / n), tick();
  }
  void print(const char* what) const {
    const SlingState& g = sling();
    std::printf("%-10s stage %d knot %.1f fed %.1f T %.2f tail %.2f pulled %.2f around %d", what, g.stage, 1e3 * g.knot,
                1e3 * g.fed, g.tension, g.tail, g.pulled, g.around_count);
    for (int i = 0; i < g.around_count; ++i) {
      const auto& a = g.around[size_t(i)];
      std::printf(" [s %.1f r %.2f sunk %.2f press %.2f pull %.2f]",
                  1e3 * arc_at(model.strand_bodies[size_t(a.strand)], {a.element, a.w}), 1e3 * a.radius,
                  1e3 * a.squeeze, a.press, length(a.pull));
    }
    const auto& x = suture().thread.x;
    const int k = int(g.knot / model.objects.sutures.list[0].thread.spacing);
    std::printf("\n     in mouth's frame:");
    for (int q = 0; q <= 8; ++q) {
      const Vec3d d = x[size_t(k * q / 8)] - g.mouth.tip;
      std::printf(" (%.0f %.0f %.0f)", 1e3 * dot(d, g.mouth.axis), 1e3 * dot(d, g.mouth.up),
                  1e3 * dot(d, cross(g.mouth.axis, g.mouth.up)));
    }
    std::printf(" mid (%.0f %.0f %.0f)\n", 1e3 * x[size_t(k / 2)].x, 1e3 * x[size_t(k / 2)].y, 1e3 * x[size_t(k / 2)].z);
  }
};

}  // namespace

TEST(Sling, TryOut) {
  Looped t;
  t.print("start");
  t.move({0.045, 0.072, -0.020}, 0.05);
  t.handle(0, 300);
  for (int i = 0; i < 8; ++i) t.ticks(500), t.print("open");
  t.move({0.030, 0.080, -0.040}, 0.05);
  t.print("over");
  t.move({0.022, 0.084, -0.052}, 0.03);
  t.print("down");
  t.move({0.008, 0.083, -0.058}, 0.03);
  t.print("near");
  t.handle(0.5, 500);
  for (int i = 0; i < 12; ++i) t.ticks(500), t.print("close");
}
