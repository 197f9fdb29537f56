// A closed clip crushes what it lies on: no tube is drawn thicker than the gap between its legs, it keeps its girth,
// and a stump beside it is a flat, pale end instead of an open one.
#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {
namespace {

const sim::Model& before_clips() {
  static const sim::Model model =
      scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy/scene.json"));
  return model;
}

int duct() { return before_clips().strand_index("cystic_duct"); }

sim::State clipped_at(double s, double cover = 1) {
  sim::State state = sim::initial_state(before_clips());
  interactions::Clip& c = state.clips[std::size_t(state.clip_count++)];
  c.strand = duct();
  c.s = s;
  c.cover = cover;
  c.opening[1] = c.axis[2] = 1;
  c.reach = 0.004;
  c.length = 0.0085;
  return state;
}

void cut_at(sim::State& state, double s) {
  interactions::Cut& c = state.cuts[std::size_t(state.cut_count++)];
  c.strand = duct();
  c.s = s;
  c.fraction = 1;
  const interactions::StrandPlace place = place_at(before_clips().strand_bodies[std::size_t(duct())], s);
  state.strands[std::size_t(duct())].alive[std::size_t(place.element)] = 0;
}

struct Extent {
  double thick = 0, wide = 0;  ///< across the legs and along them [m]
};

/// Of what is drawn of the duct from one distance of the clip's middle to another, along the strand.
Extent extent(const sim::State& state, double from, double to) {
  const auto backend = render::make_null_backend();
  TubeDrawing tube(before_clips(), duct());
  tube.create(std::vector<Paint>(tube.drawn().size()), *backend);
  tube.update(state);
  const ClipPress press = press_of(state.clips[0], before_clips(), state);
  Vec3d low{1, 1, 1}, high{-1, -1, -1};
  for (const Vec3f& p : tube.buffer().positions) {
    const Vec3d d = vec_cast<double>(p) - press.centre;
    const Vec3d q{dot(d, press.open), dot(d, press.axis), dot(d, press.normal)};
    if (std::fabs(q.z) < from || std::fabs(q.z) > to || std::fabs(q.x) > 0.006 || std::fabs(q.y) > 0.008) continue;
    low = {std::min(low.x, q.x), std::min(low.y, q.y), 0}, high = {std::max(high.x, q.x), std::max(high.y, q.y), 0};
  }
  return {high.x - low.x, high.y - low.y};
}

TEST(ClipPress, ADuctIsAsThinAsTheGapBetweenTheLegsAndSpreadsThere) {
  const sim::State state = clipped_at(0.012);
  const double across = 2 * press_of(state.clips[0], before_clips(), state).radius;
  const Extent band = extent(state, 0, 0.4 * kClipLegWidth), beside = extent(state, 0.0035, 0.005);
  EXPECT_LT(band.thick, 1.3 * 2 * kClipHalfGap);
  EXPECT_GT(band.wide, 1.15 * across) << "what is pressed flat is wider";
  EXPECT_LT(band.wide, kClipLength) << "but does not stick out beyond the legs";
  EXPECT_GT(beside.thick, 0.8 * across) << "beside the clip it is a tube again";
}

TEST(ClipPress, AStumpBesideAClipStaysFlat) {
  sim::State state = clipped_at(0.012);
  const Extent whole = extent(state, 0.0022, 0.0038);
  cut_at(state, 0.016);
  cut_at(state, 0.008);
  const Extent stump = extent(state, 0.0022, 0.0038);
  EXPECT_LT(stump.thick, 0.75 * whole.thick);
}

TEST(ClipPress, AClipOnPartOfATubeClosesNoEnd) {
  const sim::State whole = clipped_at(0.012), part = clipped_at(0.012, 0.5);
  EXPECT_TRUE(closes_end(whole.clips[0], 0.016));
  EXPECT_FALSE(closes_end(whole.clips[0], 0.012 + 2 * kSealedWithin)) << "too far away";
  EXPECT_FALSE(closes_end(part.clips[0], 0.016));
}

TEST(ClipPress, ADuctThatIsClippedAndCutIsAClosedSurface) {
  const auto backend = render::make_null_backend();
  TubeDrawing tube(before_clips(), duct());
  tube.create(std::vector<Paint>(tube.drawn().size()), *backend);
  sim::State state = clipped_at(0.010);
  cut_at(state, 0.0145);
  tube.update(state);
  geometry::TriMesh mesh;
  for (const Vec3f& p : tube.buffer().positions) mesh.positions.push_back(vec_cast<double>(p));
  for (std::size_t i = 0; i + 2 < tube.buffer().indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return int(tube.buffer().indices[i + k]); };
    mesh.triangles.push_back({at(0), at(1), at(2)});
  }
  mesh = geometry::merged_vertices(mesh, 1e-7);
  EXPECT_TRUE(geometry::check_edges(mesh).closed());
  EXPECT_GT(geometry::volume(mesh), 0);
}

TEST(ClipPress, AClosedEndIsPaleAndAnOpenOneBleeds) {
  const auto reddest = [](const sim::State& state) {
    const auto backend = render::make_null_backend();
    TubeDrawing tube(before_clips(), duct());
    tube.create(std::vector<Paint>(tube.drawn().size()), *backend);
    tube.update(state);
    int most = 0;
    for (const Paint& p : tube.buffer().paint) most = std::max(most, int(p.blood));
    return most;
  };
  sim::State closed = clipped_at(0.010);
  closed.clips[std::size_t(closed.clip_count++)] = closed.clips[0];
  closed.clips[1].s = 0.019;
  cut_at(closed, 0.0145);
  sim::State open = clipped_at(0.002);
  cut_at(open, 0.0145);
  EXPECT_LT(reddest(closed), 110);
  EXPECT_GT(reddest(open), 200);
}

}  // namespace
}  // namespace trocar::view
