// The rest of a liver. What is simulated is its lower edge; above it the organ continues below the diaphragm's dome,
// and to both sides until the wall. Drawing only: a surface that leaves the simulated one without a crease, sunk into
// it where they overlap, and that goes along where that moves. With it the falciform ligament, a sheet from the dome to
// the wall.
//
//   LiverDome dome(model, organ, LiverShape(points, triangles), wall_surface, backend);
//   dome.shade(baker);            // once
//   dome.update(state);           // after a step
#pragma once

#include <array>

#include <trocar/render/meshes/openness.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/anatomy/liver_shape.hpp>
#include <trocar/view/base/dent.hpp>
#include <trocar/view/base/listing.hpp>
#include <trocar/view/base/moved.hpp>

namespace trocar::view {

class LiverDome {
 public:
  /// @param organ number of a body whose lower edge points to the feet
  /// @param shape of it as drawn
  LiverDome(const sim::Model& model, int organ, const LiverShape& shape, const WallSurface& wall,
            render::Backend& backend);

  void shade(const render::OpennessBaker& baker);
  /// The recess between it and the diaphragm is deep: less light comes there than the baker's reach says.
  void shade_behind(std::span<const Vec3f> positions, std::span<const Vec3f> normals, std::span<Paint> paint) const;
  void update(const sim::State& state);
  void list(std::size_t part, const Listing& to);
  int organ() const { return m_organ; }
  const MeshBuffer& buffer() const { return m_dome.shape; }  ///< as drawn now

 private:
  /// What a vertex follows: places of the body's skin, and how much of their ways.
  struct Follow {
    std::uint32_t vertex = 0;
    std::array<int, 3> on{};
    std::array<float, 3> share{};
  };
  struct Part {
    MeshBuffer shape;
    std::vector<Vec3f> rest;
    std::vector<Follow> follows;
    OwnedMesh mesh;
    Detail detail;
  };
  const tissue::Skin& skin() const { return m_model->skin(m_organ); }
  void tie(Part& part) const;
  void move(Part& part);

  const sim::Model* m_model;
  int m_organ;
  Part m_dome, m_falciform;
  tissue::SkinPose m_pose;
  std::vector<Vec3f> m_way;  ///< (skin) how far the body has moved [m]
  Moved m_moved;
};

}  // namespace trocar::view
