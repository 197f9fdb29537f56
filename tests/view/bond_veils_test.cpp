// Films hang where bonds hold: beside one that has parted their border is free, where two have parted only hems are
// left. Between lobules of fat they follow links that hold, and close notches only.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/bonds/bond_veils.hpp>
#include <trocar/view/objects/fat_veils.hpp>

namespace trocar::view {
namespace {

const sim::Model& in_its_bed() {
  static const sim::Model model =
      scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed/scene.json"));
  return model;
}

std::span<const Paint> film_of(const BondVeils& veils, std::size_t pair) {
  return std::span(veils.buffer().paint).subspan(pair * BondVeils::vertices(), BondVeils::vertices());
}

double seen(std::span<const Paint> film) {
  double sum = 0;
  for (const Paint& p : film) sum += p.openness;
  return sum / (255.0 * double(film.size()));
}

TEST(BondVeils, NeighboursHaveNothingBetweenThem) {
  const std::vector<Vec3d> row{{0, 0, 0}, {0.005, 0, 0}, {0.010, 0.001, 0}, {0.050, 0, 0}};
  const std::vector<std::pair<int, int>> expected{{0, 1}, {1, 2}};
  EXPECT_EQ(neighbours(row, 0.016), expected);
}

TEST(BondVeils, AreSeenWholeOnlyBetweenBondsThatHold) {
  const auto backend = render::make_null_backend();
  BondVeils veils(in_its_bed(), 0, *backend);
  ASSERT_TRUE(veils.any());
  sim::State state = sim::initial_state(in_its_bed());
  veils.update(state);
  const double whole = seen(film_of(veils, 0));
  const auto [first, second] = veils.pairs()[0];
  state.bonds[0][std::size_t(first)].damage = 1;
  veils.update(state);
  const double beside = seen(film_of(veils, 0));
  state.bonds[0][std::size_t(second)].damage = 1;
  veils.update(state);
  const double hems = seen(film_of(veils, 0));
  EXPECT_GT(whole, 0.2);
  EXPECT_LT(beside, 0.8 * whole);
  EXPECT_GT(hems, 0) << "something is left on one side";
}

TEST(BondVeils, WhereBothBondsHavePartedNothingSpansTheGap) {
  const auto backend = render::make_null_backend();
  const sim::Model& model = in_its_bed();
  BondVeils veils(model, 0, *backend);
  sim::State state = sim::initial_state(model);
  for (interactions::BondState& bond : state.bonds[0]) bond.damage = 1;
  const std::size_t wall = std::size_t(model.bonds[0].membrane());
  const tissue::NetworkModel& network = model.membranes[wall].sheet.network;
  for (int n = 0; n < int(network.rest.size()); ++n)  // carried away
    set_position(network, state.membranes[wall].network, n, network.rest[std::size_t(n)] + Vec3d{0.1, 0, 0});
  veils.update(state);
  double longest = 0;
  const std::vector<std::uint32_t>& corners = veils.buffer().indices;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f &p = veils.buffer().positions[corners[t + k]],
                  &q = veils.buffer().positions[corners[t + (k + 1) % 3]];
      longest = std::max(longest, length(vec_cast<double>(p) - vec_cast<double>(q)));
    }
  EXPECT_LT(longest, 0.02) << "[m] of a triangle's sides";
}

/// Lobules on three sides of a notch.
VeilFrame notch() {
  VeilFrame frame;
  frame.places = {{0, 2, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}};
  frame.rest = frame.places;
  for (int i = 0; i + 1 < int(frame.places.size()); ++i) frame.links.push_back({i, i + 1});
  return frame;
}

TEST(FatVeils, CloseANotchAlongLinksThatHold) {
  VeilFrame frame = notch();
  const std::vector<FatVeil> veils = fat_veils(frame, 1);
  ASSERT_FALSE(veils.empty());
  for (const FatVeil& veil : veils)
    for (std::size_t i = 0; i + 1 < veil.size(); ++i)
      EXPECT_EQ(std::abs(veil[i + 1] - veil[i]), 1) << "only what is linked follows upon another";
  frame.links.erase(frame.links.begin() + 3);  // parted at the notch's ground
  for (const FatVeil& veil : fat_veils(frame, 1)) EXPECT_FALSE(veil.front() < 4 && veil.back() >= 4);
}

TEST(FatVeils, HangNeitherInAirNorWhereALobuleLies) {
  VeilFrame frame = notch();
  frame.links.clear();
  EXPECT_TRUE(fat_veils(frame, 1).empty());
  frame = notch();
  frame.places.push_back({1, 1, 0}), frame.rest.push_back({});
  frame.places.push_back({1, 2, 0}), frame.rest.push_back({});
  for (const FatVeil& veil : fat_veils(frame, 1)) EXPECT_FALSE(veil.front() == 0 && veil.back() == 6);
}

TEST(FatVeils, StayBetweenWhatTheyHangOn) {
  const VeilFrame frame = notch();
  MeshBuffer b;
  for (const FatVeil& veil : fat_veils(frame, 1)) add_veil(frame, veil, 1, b);
  ASSERT_FALSE(b.positions.empty());
  EXPECT_EQ(b.rest.size(), b.positions.size());
  for (const Vec3f& p : b.positions) {
    EXPECT_GE(p.x, -1e-4f);
    EXPECT_LE(p.x, 2 + 1e-4f);
    EXPECT_GE(p.y, -1e-4f);
    EXPECT_LE(p.y, 2 + 1e-4f);
  }
}

}  // namespace
}  // namespace trocar::view
