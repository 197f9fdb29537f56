#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

// Equal but for the places in files.
bool same(const StrandEnd& a, const StrandEnd& b) { return a.organ == b.organ && a.fixed == b.fixed; }
bool same(const Section& a, const Section& b) {
  return a.centre == b.centre && a.across == b.across && a.deep == b.deep && a.squareness == b.squareness;
}
bool same(const Anchor& a, const Anchor& b) {
  return a.centre == b.centre && a.radius == b.radius && a.stiffness == b.stiffness;
}
bool same(const StrandStation& a, const StrandStation& b) {
  return a.s == b.s && a.radius == b.radius && a.lumen == b.lumen;
}
bool same(const Landmark& a, const Landmark& b) { return a.name == b.name && a.from == b.from && a.to == b.to; }
bool same(const Tissue& a, const Tissue& b) {
  return a.name == b.name && a.density == b.density && a.young == b.young && a.p1 == b.p1 && a.p2 == b.p2 &&
         a.poisson == b.poisson && a.strain_cap == b.strain_cap && a.failure_strain == b.failure_strain &&
         a.damping_ms == b.damping_ms && a.source == b.source && a.source_of == b.source_of;
}
bool same(const Solid& a, const Solid& b);
bool same(const Strand& a, const Strand& b);
bool same(const Wall& a, const Wall& b);
bool same(const Sheet& a, const Sheet& b);
bool same(const Membrane& a, const Membrane& b);
bool same(const Port& a, const Port& b);
bool same(const Instrument& a, const Instrument& b);
bool same(const Placement& a, const Placement& b);
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same(a[i], b[i])) return false;
  return true;
}
bool same(const Solid& a, const Solid& b) {
  return a.name == b.name && a.tissue == b.tissue && a.look == b.look && same(a.sections, b.sections) &&
         a.cell == b.cell && a.solver == b.solver && a.elasticity == b.elasticity && a.beyond_angle == b.beyond_angle &&
         a.beyond == b.beyond && a.skin_edge == b.skin_edge && a.fine_edge == b.fine_edge && same(a.anchors, b.anchors);
}
bool same(const Strand& a, const Strand& b) {
  return a.name == b.name && a.tissue == b.tissue && a.look == b.look && a.centreline == b.centreline &&
         same(a.stations, b.stations) && same(a.landmarks, b.landmarks) && same(a.start, b.start) &&
         same(a.end, b.end) && a.spacing == b.spacing && a.foundation == b.foundation &&
         a.foundation_limit == b.foundation_limit && a.cuttable == b.cuttable && a.fimbriated == b.fimbriated;
}
bool same(const Wall& a, const Wall& b) {
  return a.name == b.name && a.look == b.look && a.rows == b.rows && a.columns == b.columns && a.net == b.net &&
         a.edge == b.edge;
}
bool same(const Sheet& a, const Sheet& b) {
  return a.name == b.name && a.look == b.look && a.strand == b.strand && a.from == b.from && a.to == b.to &&
         a.base == b.base && a.base_organ == b.base_organ;
}
bool same(const Membrane& a, const Membrane& b) {
  return a.name == b.name && a.tissue == b.tissue && a.look == b.look && a.strand == b.strand && a.from == b.from &&
         a.to == b.to && a.base == b.base && a.base_on == b.base_on && a.base_reach == b.base_reach &&
         a.thickness == b.thickness && a.spacing == b.spacing && a.cuttable == b.cuttable;
}
bool same(const Port& a, const Port& b) {
  return a.name == b.name && a.position == b.position && a.diameter == b.diameter;
}
bool same(const Instrument& a, const Instrument& b) {
  return a.name == b.name && a.title == b.title && a.kind == b.kind && a.shaft_radius == b.shaft_radius &&
         a.shaft_length == b.shaft_length && a.jaw_length == b.jaw_length && a.jaw_width == b.jaw_width &&
         a.jaw_thickness == b.jaw_thickness && a.opening == b.opening && a.parallel_gap == b.parallel_gap &&
         a.pinch_max == b.pinch_max && a.friction == b.friction && a.clip_length == b.clip_length && a.clips == b.clips;
}
bool same(const Placement& a, const Placement& b) {
  return a.instrument == b.instrument && a.port == b.port && a.tip == b.tip && a.roll == b.roll;
}
bool same(const Scope& a, const Scope& b) {
  return a.angle == b.angle && a.field_of_view == b.field_of_view && a.shaft_radius == b.shaft_radius &&
         a.shaft_length == b.shaft_length;
}
bool same(const Description& a, const Description& b) {
  return a.name == b.name && a.title == b.title && a.gravity == b.gravity && same(a.tissues, b.tissues) &&
         same(a.solids, b.solids) && same(a.strands, b.strands) && same(a.walls, b.walls) && same(a.sheets, b.sheets) &&
         same(a.membranes, b.membranes) && same(a.ports, b.ports) && same(a.instruments, b.instruments) &&
         same(a.placements, b.placements) && same(a.scope, b.scope) && same(a.scope_placement, b.scope_placement);
}

TEST(Writer, AWrittenSceneReadsBackEqualToTheBit) {
  const Folder folder;
  const Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  const Description again = read_scene(folder.write("scene.json", write_scene(d)));
  EXPECT_TRUE(same(d, again));
  EXPECT_EQ(write_scene(again), write_scene(d));
}

TEST(Writer, AWrittenPouchReadsBackWithItsContents) {
  const Folder folder;
  const Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder/scene.json");
  const Description again = read_scene(folder.write("scene.json", write_scene(d)));
  EXPECT_EQ(write_scene(again), write_scene(d));
  ASSERT_EQ(again.pouches.size(), 1u);
  const Pouch &a = d.pouches[0], &b = again.pouches[0];
  EXPECT_EQ(a.sections.size(), b.sections.size());
  EXPECT_EQ(a.held.size(), b.held.size());
  EXPECT_EQ(a.held_on, b.held_on);
  EXPECT_EQ(a.thickness, b.thickness);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.contents.kind, b.contents.kind);
  EXPECT_EQ(a.contents.pressure, b.contents.pressure);
  EXPECT_EQ(a.contents.bulk, b.contents.bulk);
  EXPECT_EQ(a.contents.density, b.contents.density);
}

TEST(Writer, PaintedStiffnessAndStrokesReadBack) {
  const Folder folder;
  Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder/scene.json");
  d.pouches[0].regions = {{{0.001, 0.0025, -0.1}, 0.012, 0.3, {}}};
  Solid& liver = d.solids[0];
  liver.regions = {{{0.01, 0, 0}, 0.03, 4, {}}, {{0.02, 0, 0}, 0.01, 1, {}}};
  liver.fibre_strokes = {{{0, 0, 0}, {0.01, 0, 0}}, {{0, 0.01, 0}, {0.01, 0.011, 0}, {0.02, 0.013, 0}}};
  liver.fibre_ratio = 1.5;
  const Description again = read_scene(folder.write("scene.json", write_scene(d)));
  EXPECT_EQ(write_scene(again), write_scene(d));
  EXPECT_EQ(again.solids[0].fibre_strokes, liver.fibre_strokes);
  const auto same_dabs = [](const std::vector<StiffnessRegion>& a, const std::vector<StiffnessRegion>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
      return p.centre == q.centre && p.radius == q.radius && p.stiffness == q.stiffness;
    });
  };
  EXPECT_TRUE(same_dabs(again.solids[0].regions, liver.regions));
  EXPECT_TRUE(same_dabs(again.pouches[0].regions, d.pouches[0].regions));
}

TEST(Writer, TheComparisonSeesOneChangedBit) {
  const Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  Description other = d;
  other.strands.back().centreline.back().z *= 1 + 0x1p-52;
  EXPECT_FALSE(same(d, other));
}

TEST(Writer, LengthsThatNobodyTypedComeBackWithinOneBit) {
  const Folder folder;
  Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  core::Random random(3);
  for (Vec3d& p : d.strands[0].centreline)
    p = p + Vec3d{random.uniform(0, 1e-4), random.uniform(0, 1e-4), random.uniform(0, 1e-4)};
  const Description again = read_scene(folder.write("scene.json", write_scene(d)));
  for (std::size_t i = 0; i < d.strands[0].centreline.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(again.strands[0].centreline[i][k], d.strands[0].centreline[i][k]);
}

}  // namespace
}  // namespace trocar::scene
