#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/seen.hpp>
#include <trocar/training/observe/stitches.hpp>

namespace trocar::training {
namespace {

using interactions::SutureBite;
using interactions::SutureHole;

constexpr double kTogether = 5;      // diameters: further apart, elements are not tied to each other
constexpr double kShaftSeen = 0.03;  // [m] of the shaft behind the jaws on which thread is looked for

}  // namespace

std::string_view needs_suture(const sim::Model& model) { return has_suture(model) ? "" : "a suture"; }
std::string_view needs_needle(const sim::Model& model) {
  return has_suture(model) && suture_of(model).has_needle() ? "" : "a suture with a needle";
}
std::string_view needs_thread(const sim::Model& model) {
  return has_suture(model) && suture_of(model).has_thread() ? "" : "a suture with a thread";
}

double bite_to_mark(const sim::Model& model, const sim::State& state, int target, bool entry) {
  const sim::VisibilityTarget& t = model.targets[std::size_t(target)];
  if (t.kind != sim::VisibilityTarget::mark) return -1;
  const sim::MarkModel& mark = model.marks[std::size_t(t.index)];
  if (!mark.on_organ() && !mark.at.body.is(BodyKind::membrane)) return -1;
  const BodyId on = mark.at.body;
  const interactions::SutureState& s = suture_of(state);
  double least = -1;
  for (int i = 0; i < s.bite_count; ++i) {
    const SutureBite& bite = s.bites[std::size_t(i)];
    if (bite.body != on || bite.stage == SutureBite::gone) continue;
    if (!entry && bite.stage == SutureBite::open) continue;
    const Vec3d at = drawn_place(sim::bodies_of(model, state), entry ? bite.entry : bite.exit);
    const double off = length(at - mark.place);
    if (least < 0 || off < least) least = off;
  }
  return least;
}

int passages_through(const sim::State& state, BodyId body) {
  const interactions::SutureState& s = suture_of(state);
  int count = 0;
  for (int i = 0; i < s.bite_count; ++i) {
    const SutureBite& bite = s.bites[std::size_t(i)];
    count += bite.body == body && bite.stage == SutureBite::through;
  }
  return count;
}

double clip_to_hole(const interactions::SutureState& suture) {
  double least = -1;
  const suture::ThreadState& thread = suture.thread;
  for (int k = 0; k < thread.clip_count; ++k)
    for (int i = 0; i < thread.clips[std::size_t(k)].count; ++i)
      for (int h = 0; h < suture.hole_count; ++h) {
        const interactions::SutureHole& hole = suture.holes[std::size_t(h)];
        if (hole.slot < 0 || hole.kind == interactions::SutureHole::track) continue;
        const double off = std::fabs(thread.clips[std::size_t(k)].s[std::size_t(i)] - double(hole.arc));
        if (least < 0 || off < least) least = off;
      }
  return least;
}

int held_of_suture(const sim::Model& model, const sim::State& state, std::size_t hand) {
  const interactions::ToolState& tool = state.tools[hand];
  if (tool.holds == 0 || !tool.hold[0].at.body.is(BodyKind::suture)) return 0;
  return interactions::on_needle(suture_of(model), tool.hold[0].at.element) ? 1 : 2;
}

bool needle_in_picture(const sim::Model& model, const sim::State& state) {
  const kinematics::ScopeFrame scope = sim::scope_of(model, state);
  const double least = portable::cos(0.5 * model.scope.field_of_view);
  const suture::NeedleModel& m = suture_of(model).needle;
  for (const double share : {0.0, 0.5}) {
    const Vec3d p = suture::needle_point(m, suture_of(state).needle, share * m.length);
    if (dot(normalised(p - scope.eye), scope.forward) > least) return true;
  }
  return false;
}

suture::KnotReading knot_of(const sim::Model& model, const sim::State& state) {
  const interactions::SutureState& s = suture_of(state);
  const suture::ThreadModel& m = suture_of(model).thread;
  double split = 0;
  int count = 0;
  for (int i = 0; i < s.hole_count; ++i) {
    const SutureHole& hole = s.holes[std::size_t(i)];
    if (hole.slot >= 0) split += double(hole.arc), ++count;
  }
  if (count == 0) return {};
  return suture::read_knot(s.thread.x, {m.spacing, split / count, kTogether * m.stuff.diameter});
}

double knot_above_tissue(const sim::Model& model, const sim::State& state, const suture::KnotReading& knot) {
  const interactions::SutureState& s = suture_of(state);
  const auto at = [&](int hole) {
    return suture::point_at(suture_of(model).thread, s.thread, double(s.holes[std::size_t(hole)].arc));
  };
  double least = 1e9;
  for (int i = 0; i < s.hole_count; ++i)
    for (int k = i; k < s.hole_count; ++k) {
      if (s.holes[std::size_t(i)].slot < 0 || s.holes[std::size_t(k)].slot < 0) continue;
      const Vec3d a = at(i), ab = at(k) - a;
      const double w = std::clamp(dot(knot.place - a, ab) / std::max(1e-12, dot(ab, ab)), 0.0, 1.0);
      least = std::min(least, length(a + w * ab - knot.place));
    }
  return least;
}

double arc_to_stitch(const sim::Model& model, const sim::State& state) {
  const interactions::SutureState& s = suture_of(state);
  double until = suture_of(model).thread.length;
  for (int i = 0; i < s.hole_count; ++i)
    if (s.holes[std::size_t(i)].slot >= 0) until = std::min(until, double(s.holes[std::size_t(i)].arc));
  return until;
}

double wraps_around(const sim::Model& model, const sim::State& state, std::size_t hand) {
  const interactions::SutureState& s = suture_of(state);
  const std::size_t nodes =
      std::min(s.thread.x.size(), std::size_t(arc_to_stitch(model, state) / suture_of(model).thread.spacing) + 1);
  const interactions::ToolShape shape = sim::shape_of(model, state, hand);
  const Vec3d axis = shape.frame.axis();
  return suture::turns_around(std::span(s.thread.x).first(nodes), shape.pivot - kShaftSeen * axis, shape.frame.tip,
                              0.008);
}

}  // namespace trocar::training
