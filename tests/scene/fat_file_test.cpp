// Fat as scenes have it: where it lies, what it holds on, how a seed moves it, and what is refused with a remedy.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/objects/fat_filling.hpp>
#include <trocar/sim/model/bodies.hpp>

using namespace trocar;
using namespace trocar::scene;

namespace {

Description calot() { return read_scene(TROCAR_SOURCE_DIR "/scenes/calot/scene.json"); }
FatSetting& fat_of(Description& d) { return settings_of(FatScene{}, d.objects).front(); }

std::string refusal(const std::function<void(FatSetting&)>& spoil) {
  Description d = calot();
  spoil(fat_of(d));
  try {
    compile(d);
  } catch (const core::BadInput& e) {
    return e.what();
  }
  return "nothing was refused";
}
bool tells(const std::string& message, const char* what) { return message.find(what) != std::string::npos; }

const interactions::FatBody& body_of(const sim::Model& m) { return m.fat.front(); }

}  // namespace

TEST(FatFile, NoLobuleLiesInWhatItSurrounds) {
  const sim::Model m = compile(calot());
  for (const Vec3d& p : body_of(m).fat.network.rest)
    for (const interactions::StrandBody& strand : m.strand_bodies)
      for (int e = 0; e < strand.nodes(); ++e)
        EXPECT_GT(length(p - strand.model.rest[size_t(e)]),
                  strand.model.radius[size_t(std::min(e, strand.nodes() - 2))]);
}

TEST(FatFile, ItHoldsOnCordsLiverAndGallbladder) {
  const sim::Model m = compile(calot());
  const interactions::FatBody& body = body_of(m);
  const BodyId duct = sim::body_of(m, "cystic_duct"), artery = sim::body_of(m, "cystic_artery");
  int on_duct = 0, on_artery = 0, on_wall = 0;
  for (const interactions::Bond& b : m.bonds[std::size_t(body.roots)].bonds) {
    on_duct += b.far.body == duct;
    on_artery += b.far.body == artery;
    on_wall += b.far.body.is(BodyKind::membrane);
  }
  EXPECT_GT(on_duct, 10);
  EXPECT_GT(on_artery, 10);
  EXPECT_GT(on_wall, 5);
  EXPECT_GT(std::count(body.fat.serosal.begin(), body.fat.serosal.end(), 1), 50);
}

TEST(FatFile, ASeedMovesItWithWhatItLiesOn) {
  Description d = calot();
  const Vec3d before = fat_of(d).fills[0].line[2];
  vary(d, 3);
  EXPECT_GT(length(fat_of(d).fills[0].line[2] - before), 1e-4);
  EXPECT_NO_THROW(compile(d));
}

TEST(FatFile, WhatCannotBeBuiltIsRefusedAndSaysWhy) {
  EXPECT_TRUE(tells(refusal([](FatSetting& s) { s.on = {"spleen"}; }), "\"spleen\""));
  EXPECT_TRUE(tells(refusal([](FatSetting& s) { s.on = {"duodenum"}; }), "got none"));
  EXPECT_TRUE(tells(refusal([](FatSetting& s) { s.fills = {{{{0.5, 0.5, 0.5}, {0.9, 0.5, 0.5}}, 0.05}}; }), "lobules"));
  EXPECT_TRUE(tells(refusal([](FatSetting& s) { s.spacing = 0.001, s.fills[0].radius = 0.02; }), "got 41"))
      << "more than a tick bears";
}
