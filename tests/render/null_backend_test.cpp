// What a backend must refuse. The null backend and the GL backend share these checks.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>

namespace trocar::render {
namespace {

const std::vector<Vec3f> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<std::uint32_t> kTriangle{0, 1, 2};

MeshData triangle() {
  MeshData data;
  data.positions = kCorners;
  data.indices = kTriangle;
  return data;
}

class NullBackend : public testing::Test {
 protected:
  std::unique_ptr<Backend> backend = make_null_backend();
  Frame frame;
  Target target = Target::off_screen(32, 24);
};

TEST_F(NullBackend, CountsTheTrianglesOfALevelAndTakesTheLastBeyondIt) {
  const std::vector<Vec3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<std::uint32_t> square{0, 1, 2, 2, 1, 3};
  const std::vector<std::vector<std::uint32_t>> half{{0, 1, 2}};
  MeshData data;
  data.positions = corners;
  data.indices = square;
  data.coarser = half;
  DrawItem item;
  item.mesh = backend->create_mesh(data);
  const auto triangles = [&](std::uint8_t level) {
    const std::uint64_t before = backend->stats().triangles;
    item.level = level;
    frame.items = {item};
    draw_frame(*backend, frame, target);
    return backend->stats().triangles - before;
  };
  EXPECT_EQ(triangles(0), 2u);
  EXPECT_EQ(triangles(1), 1u);
  EXPECT_EQ(triangles(7), 1u);
}

TEST_F(NullBackend, RefusesCoarserListsThatAreNone) {
  MeshData data = triangle();
  const std::vector<std::vector<std::uint32_t>> beyond{{0, 1, 3}}, empty{{}};
  data.coarser = beyond;
  EXPECT_THROW(backend->create_mesh(data), Misuse);
  data.coarser = empty;
  EXPECT_THROW(backend->create_mesh(data), Misuse);
}

TEST_F(NullBackend, KnowsNoCostsOfPasses) {
  std::vector<PassCost> costs;
  backend->profile(&costs);
  draw_frame(*backend, frame, target);
  EXPECT_TRUE(costs.empty());
}

TEST_F(NullBackend, CountsWhatIsDrawn) {
  const MeshHandle mesh = backend->create_mesh(triangle());
  frame.items = {{mesh, {}, {}, false}, {mesh, {}, {}, true}};
  frame.puffs = {{{0, 0, 0}, 0.01f, 0.5f}};
  draw_frame(*backend, frame, target);
  const BackendStats stats = backend->stats();
  EXPECT_EQ(stats.frames, 1u);
  EXPECT_EQ(stats.items, 2u);
  EXPECT_EQ(stats.triangles, 2u);
  EXPECT_EQ(stats.puffs, 1u);
  EXPECT_EQ(stats.vertices_uploaded, 3u);
  EXPECT_EQ(stats.meshes_alive, 1u);
}

TEST_F(NullBackend, RefusesIndexBeyondTheVertices) {
  const std::vector<std::uint32_t> wrong{0, 1, 3};
  MeshData data = triangle();
  data.indices = wrong;
  EXPECT_THROW(backend->create_mesh(data), Misuse);
}

TEST_F(NullBackend, RefusesHalfATriangle) {
  const std::vector<std::uint32_t> wrong{0, 1};
  MeshData data = triangle();
  data.indices = wrong;
  EXPECT_THROW(backend->create_mesh(data), Misuse);
  data.primitive = Primitive::lines;  // two indices are a whole line
  EXPECT_NO_THROW(backend->create_mesh(data));
}

TEST_F(NullBackend, RefusesNaNAndSaysWhere) {
  const MeshHandle mesh = backend->create_mesh(triangle());
  std::vector<Vec3f> moved = kCorners;
  moved[1].y = std::numeric_limits<float>::quiet_NaN();
  try {
    backend->update_mesh(mesh, moved, {}, {});
    FAIL() << "a NaN position was taken";
  } catch (const Misuse& misuse) {
    EXPECT_STREQ(misuse.what(), "update_mesh: positions[1] is not finite");
  }
}

TEST_F(NullBackend, RefusesArraysOfAnotherSize) {
  const MeshHandle mesh = backend->create_mesh(triangle());
  const std::vector<Vec3f> two{{0, 0, 0}, {1, 0, 0}};
  const std::vector<Paint> four(4);
  EXPECT_THROW(backend->update_mesh(mesh, two, {}, {}), Misuse);
  EXPECT_THROW(backend->update_mesh(mesh, kCorners, two, {}), Misuse);
  EXPECT_THROW(backend->update_mesh(mesh, kCorners, {}, four), Misuse);
  EXPECT_NO_THROW(backend->update_mesh(mesh, kCorners, {}, {}));
}

TEST_F(NullBackend, RefusesADeadHandle) {
  const MeshHandle mesh = backend->create_mesh(triangle());
  backend->destroy_mesh(mesh);
  EXPECT_THROW(backend->update_mesh(mesh, kCorners, {}, {}), Misuse);
  EXPECT_THROW(backend->replace_mesh(mesh, triangle()), Misuse);
  EXPECT_THROW(backend->destroy_mesh(mesh), Misuse);
  backend->begin_frame(frame, target);
  EXPECT_THROW(backend->draw({mesh, {}, {}, false}), Misuse);
}

TEST_F(NullBackend, HandlesAreNeverReused) {
  const MeshHandle first = backend->create_mesh(triangle());
  backend->destroy_mesh(first);
  EXPECT_FALSE(backend->create_mesh(triangle()) == first);
}

TEST_F(NullBackend, RefusesUnmatchedBeginAndEnd) {
  EXPECT_THROW(backend->end_frame(), Misuse);
  EXPECT_THROW(backend->draw({}), Misuse);
  EXPECT_THROW(backend->read_pixels(), Misuse);  // nothing drawn yet
  backend->begin_frame(frame, target);
  EXPECT_THROW(backend->begin_frame(frame, target), Misuse);
  EXPECT_THROW(backend->create_mesh(triangle()), Misuse);
  EXPECT_THROW(backend->read_pixels(), Misuse);
  backend->end_frame();
  EXPECT_EQ(backend->read_pixels().width, 32);
}

TEST_F(NullBackend, RefusesACameraThatCannotBe) {
  frame.camera.far_plane = frame.camera.near_plane;
  EXPECT_THROW(backend->begin_frame(frame, target), Misuse);
  frame.camera = {};
  frame.camera.rotation.m[0][0] = 2;
  EXPECT_THROW(backend->begin_frame(frame, target), Misuse);
  frame.camera = {};
  EXPECT_THROW(backend->begin_frame(frame, Target::off_screen(0, 10)), Misuse);
  frame.quality.render_scale = 0;
  EXPECT_THROW(backend->begin_frame(frame, target), Misuse);
}

TEST_F(NullBackend, RefusesAMaterialThatCannotBe) {
  const MeshHandle mesh = backend->create_mesh(triangle());
  backend->begin_frame(frame, target);
  Material material;
  material.mottle_size = 0;
  EXPECT_THROW(backend->draw({mesh, material, {}, false}), Misuse);
  material = {};
  material.fibre_axis = {0, 0, 0};
  EXPECT_THROW(backend->draw({mesh, material, {}, false}), Misuse);
  material = {};
  Mat4 wild;
  wild.m[12] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(backend->draw({mesh, material, wild, false}), Misuse);
}

TEST_F(NullBackend, ReplaceMeshTakesAnotherTopology) {
  const MeshHandle mesh = backend->create_mesh(triangle());
  const std::vector<Vec3f> four{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<std::uint32_t> two_triangles{0, 1, 2, 2, 1, 3};
  MeshData data;
  data.positions = four;
  data.indices = two_triangles;
  backend->replace_mesh(mesh, data);
  EXPECT_NO_THROW(backend->update_mesh(mesh, four, {}, {}));
  EXPECT_THROW(backend->update_mesh(mesh, kCorners, {}, {}), Misuse);
}

}  // namespace
}  // namespace trocar::render
