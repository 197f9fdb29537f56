#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/objects/sling_scene.hpp>
#include <trocar/scene/objects/suture_scene.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

constexpr double kStowedThread = 0.060;  // [m] in the loop as it is carried in
constexpr double kSpare = 0.004;         // [m] of thread behind the mouth of an open loop

const Shape& sling_shape() {
  static const Shape shape{
      "sling",
      "The thread is a loop at the mouth of an instrument of the kind \"endoloop\", with a knot that is pushed along "
      "it.",
      {keys::number("loop_mm", 20, 90, "diameter of the open loop, default 60"),
       keys::number("slides_N", 0, 20, "force that closes the loop at its knot, default 1"),
       keys::number("slips_N", 0, 60, "pull at which the knot slips, default 11")}};
  return shape;
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
    if (suture.has(key)) suture.fault(key, "expected no pose beside sling, whose instrument defines it, got one");
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
  m.path = {{0, 0, 0}, {0, 0, m.thread.length}};  // until its instrument has it
}

void expect_endoloop(const std::vector<SutureSetting>& settings, const sim::Model& model,
                     std::vector<core::Fault>& faults) {
  for (const SutureSetting& s : settings)
    if (s.sling.there && std::none_of(model.hands.begin(), model.hands.end(), brings_slings))
      faults.push_back({s.at, tr("expected an instrument of the kind \"endoloop\" that fits a hand's trocar, "
                                 "to bring in \"{}\", got none",
                                 s.name)});
}

}  // namespace trocar::scene
