#include "commands/gallery/gallery_events.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/pictures/analysis_choice.hpp>
#include <trocar/pictures/camera_choice.hpp>
#include <trocar/render/frame/image.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::app {

using view::PartGroup;
using view::PartStyle;
using view::ViewOptions;

namespace {

constexpr std::uint64_t kSecond = core::kTicksPerSecond;  // [ticks]

/// The scene at work, with an input that stays until it is changed.
struct Running {
  const sim::Model& model;
  sim::State state;
  sim::Work work = sim::make_work(model);
  sim::Input input = model.start;

  Running(const sim::Model& of, const sim::State& start) : model(of), state(start) {}
  void run(std::uint64_t ticks) {
    for (std::uint64_t i = 0; i < ticks; ++i) sim::step(model, input, state, work);
  }
  /// A hand's tip goes to a point in a second, turned about its shaft.
  void go(std::size_t hand, Vec3d to, double roll = 0) {
    const Vec3d port = model.hands[hand].port, from = kinematics::forward(port, state.tools[hand].pose()).tip;
    for (std::uint64_t i = 1; i <= kSecond; ++i) {
      const Vec3d tip = from + (double(i) / double(kSecond)) * (to - from);
      const auto instrument = input.tools[hand].instrument;
      input.tools[hand] = sim::tool_input(kinematics::inverse(port, tip, roll), 0);
      input.tools[hand].instrument = instrument;
      run(1);
    }
  }
};

struct Held {
  std::size_t hand = 0;
  int instrument = -1;  ///< in its rack; -1: no hand has one
};

Held hook_of(const sim::Model& model) {
  for (std::size_t h = 0; h < model.hands.size(); ++h)
    for (std::size_t i = 0; i < model.hands[h].rack.size(); ++i)
      if (model.hands[h].rack[i].kind == interactions::ToolKind::hook) return {h, int(i)};
  return {};
}

}  // namespace

ViewOptions close_up(const sim::Model& model, Vec3d target, double distance) {
  ViewOptions options;
  options.camera = ViewOptions::Camera::inside;
  options.target = target;
  options.eye = target + distance * normalised(model.scope.port - target, Vec3d{0, 0, 1});
  return options;
}

std::vector<Vec3d> skin_of(const sim::Model& model, int organ) {
  const tissue::Skin& skin = model.skin(organ);
  std::vector<Vec3d> places;
  for (int v = 0; v < skin.size(); ++v)
    if (skin.at_surface(v)) places.push_back(vec_cast<double>(skin.rest[std::size_t(v)]));
  return places;
}

Vec3d nearest(const std::vector<Vec3d>& places, Vec3d p) {
  return *std::min_element(places.begin(), places.end(),
                           [p](Vec3d a, Vec3d b) { return dot(a - p, a - p) < dot(b - p, b - p); });
}

void burn(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  const Held hook = hook_of(model);
  if (hook.instrument < 0 || !model.wet.there || model.organs() == 0) return;
  Running r(model, start);
  r.state.tools[hook.hand].instrument = hook.instrument;
  r.input.tools[hook.hand].instrument = hook.instrument;
  // Where both the hook comes to and the endoscope looks on.
  const Vec3d port = model.hands[hook.hand].port;
  const Vec3d place = nearest(skin_of(model, 0), 0.5 * (port + model.scope.port)), in = normalised(place - port);
  r.go(hook.hand, place + 0.001 * in);
  r.input.pedals = sim::kBlue;
  r.run(4 * kSecond);
  shots.take_outside(r.state, "coagulation", "a hook coagulates, with smoke", close_up(model, place, 0.045));
  for (int i = 0; i < 25 && r.state.fluids.smoke.fog < 0.5; ++i) r.run(kSecond);
  shots.take(r.state, "fogged lens", "the same through the endoscope: smoke has fogged the lens");
  r.input.pedals = 0;
  r.go(hook.hand, place - 0.03 * in);
  shots.take_outside(r.state, "burn", "what the hook has left behind", close_up(model, place, 0.03));
  r.input.pedals = sim::kWipe;
  r.run(kSecond * 7 / 5);  // half across
  shots.take(r.state, "wiping the lens", "the lens is wiped");
  r.input.pedals = 0;
  r.run(12 * kSecond);
  shots.take(r.state, "wiped lens", "and wiped");
}

void bleed(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  if (model.vessels.bleeder.vessel < 0 || !model.wet.there) return;
  Running r(model, start);
  const std::uint64_t latest = model.vessels.bleeder.tick + kSecond;
  while (r.work.bleed_count == 0 && r.state.tick < latest) r.run(1);
  if (r.work.bleed_count == 0) return;
  r.run(kSecond / 2);
  const Vec3d hole = r.work.bleed_count > 0 ? r.work.bleeds[0].place : Vec3d{};
  shots.take_outside(r.state, "bleeding jet", "an artery has opened: its jet", close_up(model, hole, 0.045));
  r.run(5 * kSecond);
  shots.take_outside(r.state, "bleeding film", "five seconds later", close_up(model, hole, 0.06));
  r.run(25 * kSecond);
  shots.take(r.state, "bleeding endoscope", "half a minute later, through the endoscope");
  const fluids::PoolModel& pool = model.wet.model.pool;
  const Vec3d middle = world(pool, 0.5 * pool.nx * pool.cell, 0.5 * pool.ny * pool.cell, 0.005);
  shots.take_outside(r.state, "bleeding pool", "the pool that has gathered", close_up(model, middle, 0.05));
}

namespace {

/// The strands' nodes are what one grasps; an organ's skin only where it is much nearer to p.
Vec3d nearest_tissue(const sim::Model& model, const sim::State& state, Vec3d p) {
  constexpr double kPreferred = 2;  // a strand may be this much farther away
  std::vector<Vec3d> strands, skins;
  for (const tissue::StrandState& s : state.strands) strands.insert(strands.end(), s.x.begin(), s.x.end());
  for (int i = 0; i < model.organs(); ++i) {
    const std::vector<Vec3d> skin = skin_of(model, i);
    skins.insert(skins.end(), skin.begin(), skin.end());
  }
  if (strands.empty() && skins.empty()) return p;
  if (skins.empty()) return nearest(strands, p);
  const Vec3d skin = nearest(skins, p), strand = strands.empty() ? skin : nearest(strands, p);
  return length(strand - p) > kPreferred * length(skin - p) ? skin : strand;
}

}  // namespace

void analysis(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  constexpr double kPull = 0.02;  // [m]
  Running r(model, start);
  std::size_t hand = 0;
  while (hand < model.hands.size() && model.placed(hand).kind != interactions::ToolKind::grasper) ++hand;
  ViewOptions close, far = view_of(pictures::choice_of(pictures::kCameraPresets[0]), view::orbit_around(model));
  far.walls = false;
  if (hand < model.hands.size()) {
    const Vec3d port = model.hands[hand].port;
    const Vec3d tip = kinematics::forward(port, start.tools[hand].pose()).tip;
    const Vec3d place = nearest_tissue(model, start, tip);
    const Vec3d past = 0.4 * model.placed(hand).jaw_length * normalised(place - port);
    double roll = 0;
    for (const double turned : {0.0, 0.8, 1.6, 2.4}) {  // as it lies between the jaws
      r.state = start;
      r.input = model.start;
      r.go(hand, place + past, roll = turned);
      r.input.tools[hand].handle = 1;
      r.run(kSecond / 2);
      if (r.state.tools[hand].holds > 0) break;
    }
    const auto instrument = r.input.tools[hand].instrument;
    const Vec3d up = place + past + kPull * normalised(port - place);
    for (std::uint64_t i = 1; i <= kSecond; ++i) {
      const Vec3d at = place + past + (double(i) / double(kSecond)) * (up - place - past);
      r.input.tools[hand] = sim::tool_input(kinematics::inverse(port, at, roll), 1);
      r.input.tools[hand].instrument = instrument;
      r.run(1);
    }
    close = close_up(model, place, 0.07);
  }
  const auto take = [&](const char* what, ViewOptions options, const char* text) {
    options.analysis = pictures::parse_analysis(what);
    shots.take_outside(r.state, fmt::format("analysis {}", what), text, options);
  };
  take("strain,forces", close, "a grasper pulls: strain of surfaces, and forces");
  take("springs", close, "the same: springs");
  take("strain,forces", {}, "the same through the endoscope");
  take("strain,forces", far, "the same from outside, the trocars' forces on the wall, too");
  if (model.vessels.there()) take("pressure", far, "the blood's pressure in the vessels");
}

void styles(const sim::State& start, pictures::Pictures& pictures, pictures::Shots& shots) {
  struct Choice {
    PartGroup group;
    PartStyle style;
    const char* what;
    const char* text;
  };
  constexpr Choice kChoices[] = {
      {PartGroup::organs, PartStyle::wireframe, "organs as edges", "organs as the edges of their triangles"},
      {PartGroup::organs, PartStyle::transparent, "organs transparent", "organs transparent"},
      {PartGroup::tubes, PartStyle::transparent, "tubes transparent", "tubes and ligaments transparent"},
      {PartGroup::folds, PartStyle::hidden, "folds hidden", "without folds"}};
  const std::vector<view::ScenePart>& parts = pictures.parts();
  for (const Choice& c : kChoices) {
    ViewOptions options;
    options.styles.assign(parts.size(), PartStyle::shaded);
    bool any = false;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].group == c.group) options.styles[i] = c.style, any = true;
    if (any) shots.take_outside(start, c.what, c.text, options);
  }
}

void eyes(const sim::Model& model, const sim::State& start, pictures::PictureSize size, pictures::Shots& shots) {
  for (const pictures::StereoName& n : pictures::kStereoNames) {
    if (!n.mode || n.mode == render::StereoMode::quad_buffer) continue;
    const std::string what = fmt::format("two eyes {}", n.name);
    if (!shots.wants(what)) continue;
    pictures::Pictures pictures(model, size, {{n.mode, {}, false}, {}});
    shots.take_image(start, what, tr("for two eyes: {}", n.meaning), pictures.still(start));
  }
}

}  // namespace trocar::app
