// An instrument at a deforming organ: what it costs each tick to fit the search structure to where the surface is now,
// and to find every triangle that the instrument's shaft touches. 20,000 triangles, a shaft of 5 mm; the same by Bullet
// (GImpact, the shape that it has for deforming meshes) and by FCL (its fastest kind of box) in the same run. The
// minimum over all rounds is what is reported, as "best_us": other work on the machine only ever adds.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include <trocar/geometry/surfaces/block_boxes.hpp>

#ifdef TROCAR_BULLET
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#endif
#ifdef TROCAR_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/collision.h>
#endif

namespace {

using namespace trocar;
using namespace trocar::geometry;

/// An ellipsoid of an organ's size that breathes; 100 x 101 points, 20,000 triangles.
struct Organ {
  static constexpr int kRound = 100, kDeep = 101;
  std::vector<Vec3d> rest;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vec3f> now;

  Organ() {
    for (int j = 0; j < kDeep; ++j)
      for (int i = 0; i < kRound; ++i) {
        const double u = 2 * std::numbers::pi * i / kRound, v = std::numbers::pi * (j + 0.5) / kDeep;
        rest.push_back({0.040 * std::sin(v) * std::cos(u), 0.025 * std::sin(v) * std::sin(u), 0.020 * std::cos(v)});
      }
    for (int j = 0; j + 1 < kDeep; ++j)
      for (int i = 0; i < kRound; ++i) {
        const int a = i + j * kRound, b = (i + 1) % kRound + j * kRound, c = a + kRound, d = b + kRound;
        triangles.push_back({a, c, b});
        triangles.push_back({b, c, d});
      }
    now.resize(rest.size());
    move(0);
  }
  void move(int tick) {
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const double wave = 1 + 0.05 * std::sin(0.1 * tick + 60 * rest[i].x);
      now[i] = vec_cast<float>(wave * rest[i]);
    }
  }
};

/// A shaft that dents the surface from above, a little elsewhere each tick.
struct Shaft {
  static constexpr float kRadius = 0.0025f;
  Vec3f a, b;
  explicit Shaft(int tick) {
    const float x = 0.02f * std::sin(0.05f * float(tick));
    a = {x, 0.0f, 0.019f};
    b = {x + 0.02f, 0.01f, 0.15f};
  }
};

/// Calls `tick(number)` with the organ moved and `prepare()` called before, and reports the quickest.
template <class Tick, class Prepare>
void run(benchmark::State& state, Organ& organ, Tick&& tick, Prepare&& prepare) {
  double best = 1e9;
  int number = 0, touched = 0;
  for (auto _ : state) {
    organ.move(++number);
    prepare();
    const auto from = std::chrono::steady_clock::now();
    touched = tick(number);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
    best = std::min(best, took);
    state.SetIterationTime(took);
  }
  state.counters["best_us"] = best * 1e6;
  state.counters["triangles"] = double(organ.triangles.size());
  state.counters["touched"] = touched;
}

constexpr auto kNothing = [] {};

void blocks(benchmark::State& state) {
  Organ organ;
  const TriangleBlocks cut = cut_into_blocks(organ.rest, organ.triangles);
  std::vector<Box> boxes(std::size_t(cut.count()));
  run(
      state, organ,
      [&](int tick) {
        const Shaft shaft(tick);
        int touched = 0;
        refit(cut, organ.now, boxes);
        visit_near_capsule(cut, boxes, organ.now, shaft.a, shaft.b, Shaft::kRadius,
                           [&](int, const SegmentTriangle<float>&) noexcept { ++touched; });
        return touched;
      },
      kNothing);
}
BENCHMARK(blocks)->Iterations(300)->UseManualTime()->Unit(benchmark::kMicrosecond);

#ifdef TROCAR_BULLET
struct Touching : btTriangleCallback {
  const Shaft& shaft;
  int touched = 0;
  explicit Touching(const Shaft& s) : shaft(s) {}
  void processTriangle(btVector3* p, int, int) override {
    const auto corner = [p](int i) { return Vec3f{float(p[i].x()), float(p[i].y()), float(p[i].z())}; };
    const auto c = closest_segment_triangle(shaft.a, shaft.b, corner(0), corner(1), corner(2));
    touched += c.distance2 < Shaft::kRadius * Shaft::kRadius;
  }
};

void bullet_gimpact(benchmark::State& state) {
  Organ organ;
  btTriangleIndexVertexArray arrays(int(organ.triangles.size()), &organ.triangles[0][0], 3 * sizeof(int),
                                    int(organ.now.size()), reinterpret_cast<btScalar*>(organ.now.data()),
                                    sizeof(Vec3f));
  btGImpactMeshShape shape(&arrays);
  shape.updateBound();
  run(
      state, organ,
      [&](int tick) {
        const Shaft shaft(tick);
        shape.postUpdate();
        shape.updateBound();
        Touching touching(shaft);
        const float r = Shaft::kRadius;
        const btVector3 low(std::min(shaft.a.x, shaft.b.x) - r, std::min(shaft.a.y, shaft.b.y) - r,
                            std::min(shaft.a.z, shaft.b.z) - r);
        const btVector3 high(std::max(shaft.a.x, shaft.b.x) + r, std::max(shaft.a.y, shaft.b.y) + r,
                             std::max(shaft.a.z, shaft.b.z) + r);
        shape.processAllTriangles(&touching, low, high);
        return touching.touched;
      },
      kNothing);
}
BENCHMARK(bullet_gimpact)->Iterations(300)->UseManualTime()->Unit(benchmark::kMicrosecond);
#endif

#ifdef TROCAR_FCL
void fcl_boxes(benchmark::State& state) {
  Organ organ;
  std::vector<fcl::Vector3f> points(organ.now.size());
  const auto convert = [&] {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {organ.now[i].x, organ.now[i].y, organ.now[i].z};
  };
  convert();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : organ.triangles) triangles.emplace_back(std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2]));
  fcl::BVHModel<fcl::AABBf> model;
  model.beginModel();
  model.addSubModel(points, triangles);
  model.endModel();
  run(
      state, organ,
      [&](int tick) {
        const Shaft shaft(tick);
        model.beginUpdateModel();
        model.updateSubModel(points);
        model.endUpdateModel(true, true);
        const Vec3f along = shaft.b - shaft.a, middle = 0.5f * (shaft.a + shaft.b);
        const fcl::Vector3f axis(along.x, along.y, along.z);
        fcl::Transform3f place = fcl::Transform3f::Identity();
        place.linear() = Eigen::Quaternionf::FromTwoVectors(fcl::Vector3f::UnitZ(), axis).toRotationMatrix();
        place.translation() = fcl::Vector3f(middle.x, middle.y, middle.z);
        const fcl::Capsulef capsule(Shaft::kRadius, axis.norm());
        fcl::CollisionRequestf request(1000, false);
        fcl::CollisionResultf result;
        return int(fcl::collide(&model, fcl::Transform3f::Identity(), &capsule, place, request, result));
      },
      convert);
}
BENCHMARK(fcl_boxes)->Iterations(300)->UseManualTime()->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
