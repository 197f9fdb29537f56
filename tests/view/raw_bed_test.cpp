// The bed of a gallbladder on the liver shows what became of its bonds: nothing while they hold, raw and bloody where
// they were torn, crusts of all shades where current went.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/anatomy/raw_bed.hpp>
#include <trocar/view/base/peeled.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::view {
namespace {

const sim::Model& bedded() {
  static const sim::Model model =
      scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed/scene.json"));
  return model;
}

std::size_t solid_with_bed() {
  for (std::size_t s = 0; s < bedded().solids.size(); ++s)
    if (RawBed::lies_on(bedded(), s)) return s;
  ADD_FAILURE() << "no bed";
  return 0;
}

struct BedScene {
  std::unique_ptr<render::Backend> backend = render::make_null_backend();
  const sim::SolidModel& solid = bedded().solids[solid_with_bed()];
  OrganDrawing organ{solid, {}, std::vector<Paint>(solid.fine.rest.size()), *backend};
  RawBed bed{bedded(), solid_with_bed(), organ, *backend};
  sim::State state = sim::initial_state(bedded());

  void part_all(interactions::BondState::Cause cause) {
    for (auto& set : state.bonds)
      for (interactions::BondState& bond : set) bond = {1, cause};
    bed.update(state, organ);
  }
  /// Those that stand out of the organ's skin.
  std::vector<std::size_t> shown() const {
    std::vector<std::size_t> out;
    for (std::size_t v = 0; v < bed.buffer().size(); ++v) {
      float nearest = 1, side = 0;
      for (std::size_t i = 0; i < organ.positions().size(); ++i) {
        const Vec3f off = bed.buffer().rest[v] - organ.positions()[i];
        if (dot(off, off) >= nearest) continue;
        nearest = dot(off, off);
        side = dot(bed.buffer().positions[v] - bed.buffer().rest[v], organ.normals()[i]);
      }
      if (side > 0.0006f) out.push_back(v);  // it lay 0.6 mm below
    }
    return out;
  }
};

TEST(RawBed, ShowsNothingWhileBondsHold) {
  BedScene s;
  s.bed.update(s.state, s.organ);
  EXPECT_FALSE(s.bed.any());
}

TEST(RawBed, WhatCurrentPartedIsACrustOfManyShades) {
  BedScene s;
  s.part_all(interactions::BondState::burnt);
  ASSERT_TRUE(s.bed.any());
  const std::vector<std::size_t> shown = s.shown();
  ASSERT_GT(shown.size(), 500u);
  const auto share = [&](auto&& is) {
    return double(
               std::count_if(shown.begin(), shown.end(), [&](std::size_t v) { return is(s.bed.buffer().paint[v]); })) /
           double(shown.size());
  };
  EXPECT_GT(share([](Paint p) { return p.burn < 40; }), 0.1) << "raw between";
  EXPECT_GT(share([](Paint p) { return p.burn > 150 && p.burn < 225; }), 0.2) << "tan and brown";
  EXPECT_GT(share([](Paint p) { return p.burn >= 225; }), 0.03) << "black";
  EXPECT_GT(share([](Paint p) { return p.blood > 100; }), 0.003) << "small vessels";
}

TEST(RawBed, WhatWasTornBleedsAndIsNotBurnt) {
  BedScene s;
  s.part_all(interactions::BondState::pulled);
  for (const std::size_t v : s.shown()) {
    EXPECT_LT(s.bed.buffer().paint[v].burn, 5);
    if (s.bed.buffer().paint[v].tint > 100) {
      EXPECT_GT(s.bed.buffer().paint[v].blood, 20);
    }
  }
}

TEST(RawBed, ItsBorderLiesBelowTheSkin) {
  BedScene s;
  s.part_all(interactions::BondState::burnt);
  const MeshBuffer& mesh = s.bed.buffer();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{mesh.indices[t + k], mesh.indices[t + (k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    if (edges.count({edge.second, edge.first})) continue;
    // At rest it lay 0.6 mm below the skin.
    EXPECT_LT(length(mesh.positions[edge.first] - mesh.rest[edge.first]), 0.00056f);
  }
}

TEST(Peeled, AWallIsRawWhereItWasTiedAndHasAPaleRimAroundThat) {
  const auto membrane = std::size_t(bedded().bonds[0].membrane());
  const std::vector<Vec3d>& places = bedded().membranes[membrane].sheet.network.rest;
  Peeled wall(bedded(), int(membrane), places);
  sim::State state = sim::initial_state(bedded());
  EXPECT_FALSE(wall.update(state)) << "nothing has parted";
  for (interactions::BondState& bond : state.bonds[0]) bond = {1, interactions::BondState::pulled};
  EXPECT_TRUE(wall.update(state));
  EXPECT_FALSE(wall.update(state)) << "that was told";
  int raw = 0, rim = 0, whole = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Peeled::Mark& m = wall.at(i);
    raw += m.blood > 50 ? 1 : 0;
    rim += m.burn > 20 && m.high > 0.0001f ? 1 : 0;
    whole += m.blood == 0 && m.burn == 0 && m.high == 0 ? 1 : 0;
    EXPECT_LT(m.burn, 70) << "no current went there";
  }
  EXPECT_GT(raw, 10);
  EXPECT_GT(rim, 3);
  EXPECT_GT(whole, int(places.size()) / 3) << "its other side";
}

TEST(RawBed, IsAnItemOfThePicture) {
  const auto backend = render::make_null_backend();
  SceneView view(bedded(), *backend);
  sim::State state = sim::initial_state(bedded());
  const std::size_t before = view.frame(state, {}).items.size();
  state.bonds[0][0] = {1, interactions::BondState::burnt};
  const render::Frame frame = view.frame(state, {});
  EXPECT_EQ(frame.items.size(), before + 1);
  EXPECT_NO_THROW(render::draw_frame(*backend, frame, render::Target::off_screen(64, 48)));
}

}  // namespace
}  // namespace trocar::view
