// Another anatomy that some patients have: as often as is declared, all else as ever, and a sound scene with each.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/variant.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

const Description& calot_drawn() {
  static const Description read = read_scene(TROCAR_SOURCE_DIR "/scenes/calot/scene.json");
  return read;
}

Description with_variant(const char* name, std::uint64_t seed = 0) {
  Description d = calot_drawn();
  d.variant = name;
  vary(d, seed);
  return d;
}

template <class List>
const auto* find_in(const List& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

double way_along(const Strand& s) {
  double sum = 0;
  for (std::size_t i = 1; i < s.centreline.size(); ++i) sum += length(s.centreline[i] - s.centreline[i - 1]);
  return sum;
}

}  // namespace

TEST(Variant, EachIsAsFrequentAsItsSourceSays) {
  constexpr int kPatients = 4000;
  const VariationSetting& variation = *calot_drawn().variation;
  std::map<std::string, int> found;
  for (std::uint64_t seed = 1; seed <= kPatients; ++seed) {
    const VariationSetting::Variant* v = drawn_variant(variation, seed);
    ++found[v ? v->name : kCommonAnatomy];
  }
  double rest = 1;
  const auto expect_share = [&](const std::string& name, double share) {
    const double deviation = std::sqrt(kPatients * share * (1 - share));
    EXPECT_NEAR(found[name], kPatients * share, 3.5 * deviation) << name;
  };
  ASSERT_EQ(variation.variants.size(), 4u);
  for (const VariationSetting::Variant& v : variation.variants) {
    expect_share(v.name, v.share);
    rest -= v.share;
  }
  expect_share(kCommonAnatomy, rest);
  EXPECT_DOUBLE_EQ(find_variant(variation, "double_artery")->share, 0.13) << "[CT.2024.5061]";
  EXPECT_DOUBLE_EQ(find_variant(variation, "hump")->share, 0.038) << "[Asghar 2023]";
}

TEST(Variant, SeedZeroIsAsDrawnToTheBit) {
  Description without = calot_drawn(), zero = calot_drawn();
  without.variation->variants.clear();
  vary(zero, 0);
  EXPECT_EQ(compile(zero).hash, compile(without).hash);
  EXPECT_EQ(zero.anatomy, kCommonAnatomy);
  EXPECT_EQ(without.anatomy, "");
}

TEST(Variant, WhatASeedDrawsElseStaysAsItWas) {
  int common = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    Description with = calot_drawn(), without = calot_drawn();
    without.variation->variants.clear();
    vary(with, seed);
    vary(without, seed);
    for (const Tissue& t : without.tissues) EXPECT_EQ(find_in(with.tissues, t.name)->young, t.young) << seed;
    for (std::size_t i = 0; i < without.pouches.size(); ++i)
      EXPECT_EQ(with.pouches[i].sections[3].deep, without.pouches[i].sections[3].deep) << seed;
    EXPECT_EQ(find_in(with.strands, "common_duct")->foundation, find_in(without.strands, "common_duct")->foundation);
    (with.anatomy == kCommonAnatomy ? common : others)++;
    if (with.anatomy == kCommonAnatomy && seed == 1) {
      EXPECT_EQ(compile(with).hash, compile(without).hash) << seed;
    }
  }
  EXPECT_GT(common, 0);
  EXPECT_GT(others, 0);
}

// Which documents and other tests name: they stay the patients that they were.
TEST(Variant, SeedsOneToNineHaveTheCommonAnatomy) {
  for (std::uint64_t seed = 0; seed <= 9; ++seed) EXPECT_EQ(drawn_variant(*calot_drawn().variation, seed), nullptr);
}

TEST(Variant, ASceneWithEachIsSoundAndSaysWhichItIs) {
  for (const VariationSetting::Variant& v : calot_drawn().variation->variants) {
    CompileReport report;
    const sim::Model model = compile(with_variant(v.name.c_str()), &report);
    EXPECT_EQ(model.anatomy, v.name);
    EXPECT_EQ(model.anatomy_title, v.title);
    for (const core::Fault& warning : report.warnings) ADD_FAILURE() << v.name << ": " << to_string(warning);
  }
}

TEST(Variant, ADoubleArteryIsOneMoreStrandWithAVesselAndAHoldAndFat) {
  const Description d = with_variant("double_artery"), &common = calot_drawn();
  ASSERT_EQ(d.strands.size(), common.strands.size() + 1);
  EXPECT_EQ(d.strands.back().name, "cystic_artery_second");
  ASSERT_EQ(d.vessels.size(), 1u) << "in place of the tree, not beside it";
  EXPECT_EQ(d.vessels[0].vessels.size(), common.vessels[0].vessels.size() + 2);
  EXPECT_EQ(d.pouches[0].held.size(), common.pouches[0].held.size() + 1);
  const auto& fat = settings_of(FatScene{}, d.objects)[0];
  EXPECT_EQ(fat.fills.size(), settings_of(FatScene{}, common.objects)[0].fills.size() + 1);
  const sim::Model model = compile(d);
  EXPECT_GE(model.vessel_index("cystic_second"), 0);
}

TEST(Variant, AHumpBringsTheRightHepaticArteryToTheNeckAndShortensTheCysticOne) {
  const Description d = with_variant("hump");
  ASSERT_EQ(d.strands.size(), calot_drawn().strands.size());
  const Strand &artery = *find_in(d.strands, "cystic_artery"), &hump = *find_in(d.strands, "right_hepatic_artery");
  EXPECT_LT(way_along(artery), 0.5 * way_along(*find_in(calot_drawn().strands, "cystic_artery")));
  const Vec3d neck = find_in(d.strands, "cystic_duct")->centreline.back();
  double near = 1;
  for (const Vec3d& p : hump.centreline) near = std::min(near, length(p - neck));
  EXPECT_LT(near, 0.013) << "of the gallbladder's neck";
}

// A seed that bends space bends what the variant brought, too: it stays where the rest is.
TEST(Variant, WhatItBringsIsVariedWithTheRest) {
  for (const std::uint64_t seed : {3u, 17u}) {
    const Description d = with_variant("double_artery", seed);
    const Strand &first = *find_in(d.strands, "cystic_artery"), &second = *find_in(d.strands, "cystic_artery_second");
    const Description drawn = with_variant("double_artery");
    const double apart = length(second.centreline.back() - first.centreline.back());
    const double as_drawn = length(find_in(drawn.strands, "cystic_artery_second")->centreline.back() -
                                   find_in(drawn.strands, "cystic_artery")->centreline.back());
    EXPECT_NEAR(apart, as_drawn, 0.11 * as_drawn);
    EXPECT_NE(second.centreline.back(), find_in(drawn.strands, "cystic_artery_second")->centreline.back());
  }
}

TEST(Variant, AFileMayAskForOne) {
  const Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/calot_double/scene.json");
  EXPECT_EQ(d.variant, "double_artery");
  for (const std::uint64_t seed : {0u, 1u, 2u}) {
    Description varied = d;
    vary(varied, seed);
    EXPECT_EQ(varied.anatomy, "double_artery") << seed;
  }
}

TEST(Variant, IsWrittenAsItWasRead) {
  const Folder folder;  // far from the library that has its instruments' mechanisms
  const Description copy = read_scene(folder.write("copy.json", write_scene(calot_drawn())));
  Description b = copy;
  b.variant = "low_artery";  // which has all that one can bring
  vary(b, 0);
  EXPECT_EQ(compile(with_variant("low_artery")).hash, compile(b).hash);
}

}  // namespace trocar::scene
