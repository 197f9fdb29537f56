#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/objects/sling_scene.hpp>
#include <trocar/scene/objects/suture_scene.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

constexpr double kStowedThread = 0.060;  // [m] in the loop as it is carried in
constexpr double kSpare = 0.004;         // [m] of thread behind the mouth of an open loop
constexpr double kThreadsApart = 0.55;   // of its thickness, from the axis, at the mouth
constexpr int kTurns = 96;               // corners of the drawn path

const Shape& sling_shape() {
  static const Shape shape{
      "sling",
      "The thread is a loop at the mouth of an instrument of the kind \"endoloop\", with a knot that is pushed along "
      "it.",
      {keys::number("loop_mm", 20, 90, "diameter of the open loop, default 60"),
       keys::number("slides_N", 0, 20, "what closing the loop takes at its knot, default 1"),
       keys::number("slips_N", 0, 60, "pull at which the knot gives way again, default 11")}};
  return shape;
}

/// How an open loop lies: both threads leave along the tube, bend apart, go straight on and meet in an arc. All of it
/// grows with the thread that there is.
struct Pear {
  double flare = 0, leg = 0;    ///< lengths of the bend apart and of the straight piece [m]
  double bends = 0, round = 0;  ///< radius of that bend, and of the arc [m]
  double thread = 0;

  /// Curvature, positive to the inside.
  double curvature(double s) const {
    const double from_end = std::min(s, thread - s);
    if (from_end < flare) return -1 / bends;
    return from_end < flare + leg ? 0 : 1 / round;
  }
};
Pear pear_of(double thread) {
  constexpr double kApart = 0.6, kFlare = 0.106;  // [rad] of each leg from the tube's axis; of the thread
  const double c = portable::cos(kApart), s = portable::sin(kApart), turn = portable::pi + 2 * kApart;
  Pear p;
  p.thread = thread;
  p.flare = kFlare * thread;
  p.bends = p.flare / kApart;
  // the arc's middle lies on the axis: round c = bends (1 - c) + leg s
  p.leg = (thread - 2 * p.flare - turn * p.bends * (1 - c) / c) / (2 + turn * s / c);
  p.round = (p.bends * (1 - c) + p.leg * s) / c;
  return p;
}

/// In the mouth's frame: along the tube, across it in the loop's plane, across that.
std::vector<Vec3d> path_from_mouth(double thickness) {
  const Pear pear = pear_of(kStowedThread);
  const double off = kThreadsApart * thickness, step = kStowedThread / kTurns;
  std::vector<Vec3d> path{{0, -off, 0}};
  double angle = 0;
  for (int k = 0; k < kTurns; ++k) {
    angle += step * pear.curvature((k + 0.5) * step);
    const double middle = angle - 0.5 * step * pear.curvature((k + 0.5) * step);
    path.push_back(path.back() + step * Vec3d{portable::cos(middle), portable::sin(middle), 0});
  }
  const double up = off - path.back().y, ahead = -path.back().x;  // what the steps are wrong by
  for (int k = 0; k <= kTurns; ++k) path[std::size_t(k)] += (double(k) / kTurns) * Vec3d{ahead, up, 0};
  path.push_back({-1, off, 0});
  return path;
}

bool brings_slings(const sim::HandModel& hand) {
  return std::any_of(hand.rack.begin(), hand.rack.end(),
                     [](const interactions::ToolModel& tool) { return tool.can().sling; });
}

}  // namespace

double SlingSetting::thread() const noexcept { return portable::pi * loop + kSpare; }

Key sling_key() {
  return keys::object("sling", sling_shape, "a loop that an instrument brings in; a thread without a needle");
}

SlingSetting read_sling(const JsonObject& suture, const SutureSetting& s) {
  SlingSetting out;
  if (!suture.has("sling")) return out;
  const JsonObject o = suture.objects("sling").front();
  out.there = true;
  out.loop = o.number("loop_mm", 1000 * out.loop) / 1000;
  out.slides = o.number("slides_N", out.slides);
  out.slips = o.number("slips_N", out.slips);
  if (s.size.empty()) suture.fault("sling", "expected a size beside sling, got none");
  if (!s.needle.empty()) suture.fault("sling", "expected a thread without a needle, got one");
  for (const char* key : {"length_mm", "line_mm", "held_by", "at_mm"})
    if (suture.has(key)) suture.fault(key, "expected nothing beside sling, whose instrument says where it is, got it");
  if (!(out.slips > out.slides)) o.fault("slips_N", "expected more than slides_N, got no more");
  return out;
}

void compile_sling(const SlingSetting& s, std::int32_t first_hold, interactions::SutureModel& m) {
  interactions::SlingModel& g = m.sling;
  g.loop = portable::pi * s.loop;
  g.stowed = std::min(kStowedThread, g.loop);
  g.slides = s.slides;
  g.slips = s.slips;
  g.first_hold = first_hold;
  m.path = path_from_mouth(m.thread.stuff.diameter);
  const suture::ThreadState laid = suture::laid(m.thread, m.path);
  g.laid = laid.x;
  g.directors = laid.director;
  // At rest it is bent as the open loop lies.
  const Pear open = pear_of(g.loop);
  g.bend.resize(laid.x.size());
  for (std::size_t n = 1; n + 1 < laid.x.size(); ++n) {
    const double arc = double(n) * m.thread.spacing;
    if (arc > g.loop) break;
    const double bend = m.thread.spacing * open.curvature(arc);
    const Vec3d before = normalised(laid.x[n] - laid.x[n - 1]), after = normalised(laid.x[n + 1] - laid.x[n]);
    const Vec3d along = normalised(before + after, after), inside{-along.y, along.x, 0};
    const Vec3d director = normalised(laid.director[n] - dot(laid.director[n], along) * along, inside);
    g.bend[n] = {bend * dot(inside, director), bend * dot(inside, cross(along, director)), 0};
  }
}

void expect_endoloop(const std::vector<SutureSetting>& settings, const sim::Model& model,
                     std::vector<core::Fault>& faults) {
  for (const SutureSetting& s : settings)
    if (s.sling.there && std::none_of(model.hands.begin(), model.hands.end(), brings_slings))
      faults.push_back({s.at, fmt::format("expected an instrument of the kind \"endoloop\" that fits a hand's trocar, "
                                          "to bring in \"{}\", got none",
                                          s.name)});
}

}  // namespace trocar::scene
