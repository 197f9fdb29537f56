// An organ's drawn skin, x = W q, with normals of its present shape, its relief, and wounds where it was cut: there the
// cut triangles lie deeper, as a raw bed with walls up to the skin around.
#pragma once

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/dent.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/moved.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/blanching.hpp>

namespace trocar::view {

class OrganDrawing {
 public:
  /// @param paint one per vertex of solid.fine (baked openness)
  OrganDrawing(const sim::SolidModel& solid, const Relief& relief, std::vector<Paint> paint, render::Backend& backend,
               const Detail& detail = {});

  /// Moves the mesh; costs nothing where no node has moved since the last time and no instrument touches it.
  /// @param parted one byte a triangle of solid.fine, 1 = cut open (empty: none)
  /// @param rods instruments that may touch it: they leave a dent, finer than the mechanics resolve
  /// @param burnt what heat has left on the vertices of solid.fine, where that has changed; else null
  /// @param blanched what a drug has, likewise
  void update(const tissue::NetworkState& state, std::span<const std::uint8_t> parted = {},
              std::span<const collision::Capsule> rods = {}, const HeatMarks* burnt = nullptr,
              const Blanching* blanched = nullptr);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  bool dented() const { return m_dented; }  ///< by an instrument
  /// Rises whenever it is drawn again: what follows it looks whether it has to.
  std::uint64_t version() const { return m_version; }
  /// As drawn now, per vertex of solid.fine.
  std::span<const Vec3f> positions() const { return m_pose.position; }
  std::span<const Vec3f> normals() const { return m_normals; }
  std::span<const Paint> paint() const { return m_paint; }

 private:
  void lift();
  void shrink_burns();
  void open_wounds(std::span<const std::uint8_t> parted);
  void sink_wounds();

  const sim::SolidModel* m_solid;
  tissue::SkinPose m_pose;
  std::vector<std::uint32_t> m_indices;
  std::vector<Vec3f> m_rest;                          ///< for patterns
  std::vector<std::vector<std::uint32_t>> m_coarser;  ///< of the uncut skin
  std::vector<Vec3f> m_normals;
  /// A vertex of a wound: a copy of a skin vertex, `depth` below it [m].
  struct WoundVertex {
    std::uint32_t of = 0;
    float depth = 0;
  };
  /// A vertex on a wound's border and the next ones along it.
  struct RimVertex {
    std::uint32_t at = 0, before = 0, after = 0;
  };
  std::vector<RimVertex> m_rim;
  std::vector<std::uint8_t> m_parted;    ///< as drawn
  std::vector<WoundVertex> m_wound;      ///< they follow the skin's vertices in the mesh
  std::vector<Paint> m_paint;            ///< of the skin
  std::vector<std::uint8_t> m_own_tint;  ///< of its paint, where it is not blanched; empty: it never was
  MeshBuffer m_open;                     ///< skin and wounds, where there are any
  std::vector<float> m_height;           ///< relief; empty: none
  tissue::Box m_box;                     ///< of the drawn vertices
  bool m_dented = false;                 ///< as drawn
  std::uint64_t m_version = 1;
  Moved m_moved;
  OwnedMesh m_mesh;
};

/// Triangles of a skin as the backend wants them.
std::vector<std::uint32_t> flat_indices(const tissue::Skin& skin);

}  // namespace trocar::view
