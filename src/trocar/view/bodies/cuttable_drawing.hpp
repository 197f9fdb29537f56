// An organ that can be cut, as drawn: its faces as smooth small triangles (tissue/tets/face_skin.hpp) with the look's
// relief, and, where a cut has laid its inside bare, raw flesh with sharp rims. A new skin is made after every cut.
// A cut gapes wider than in the simulation, where its sides lie against each other again: tissue is under tension, and
// one would see no wound (drawn only).
#pragma once

#include <trocar/render/frame/liquid.hpp>
#include <trocar/render/meshes/openness.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/tissue/tets/face_skin.hpp>
#include <trocar/view/base/dent.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/moved.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/cut_shape.hpp>

namespace trocar::view {

class CuttableDrawing {
 public:
  /// @param gravity  along which blood runs
  CuttableDrawing(const sim::CuttableOrgan& organ, Relief relief, render::Backend& backend,
                  Vec3d gravity = {0, 0, -9.81});

  /// How open its own surface lies, from what stands around it; once, before the first picture.
  void shade(const render::OpennessBaker& baker);
  /// Moves the mesh, or makes it again where the State has another cut than the last; nothing where nothing has moved.
  /// @param rods  instruments that may dent it
  void update(const tissue::CuttableState& state, std::span<const collision::Capsule> rods = {});
  /// What heat has left; before update().
  void burn(const sim::State& state, HeatMarks& marks);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  bool cut() const { return !m_bare.empty(); }
  /// Blood that runs down from cuts; after update().
  void list_ooze(render::Liquid& liquid) const;
  /// From where it has dripped.
  std::span<const Vec3f> drips() const { return m_drips; }
  /// As drawn now.
  std::span<const Vec3f> positions() const { return m_pose.position; }
  std::span<const std::uint32_t> indices() const { return m_indices; }

 private:
  void make_skin(const tissue::CuttableState& state);
  void paint_skin();
  void paint_lip(std::size_t vertex, bool loose);
  void find_rim();
  std::vector<Vec3f> outwards() const;
  void run_blood();
  void paint_blood();
  void cover(std::size_t vertex, double share);
  void find_cut();
  void gape();
  void fray();
  void roughen();
  void place(const tissue::CuttableState& state, std::span<const collision::Capsule> rods);

  const sim::CuttableOrgan* m_organ;
  Relief m_relief;
  Vec3f m_down;  ///< unit
  tissue::FaceSkin m_skin;
  std::uint64_t m_version = ~0ull;   ///< CuttableState::version of m_skin
  std::vector<std::uint8_t> m_open;  ///< (nodes) Paint::openness
  tissue::SkinPose m_pose;
  std::vector<Vec3f> m_normals;
  std::vector<Paint> m_paint;
  std::vector<float> m_height;         ///< relief
  std::vector<std::uint8_t> m_at_rim;  ///< (vertices) 1: between nodes where the inside is bare
  std::vector<std::uint32_t> m_indices;
  std::vector<std::uint32_t> m_rim, m_around;  ///< vertices of the skin along a cut, and as far as blood runs from it
  /// What gapes: vertices of the bare triangles, nodes around them and their neighbours along the skin.
  std::vector<std::array<std::uint32_t, 3>> m_bare;
  std::vector<std::array<int, 2>> m_beside;
  std::vector<std::uint8_t> m_mouth;       ///< (nodes) 1: on the body's own surface
  std::vector<std::uint8_t> m_loose;       ///< (nodes) 1: of a piece that has detached
  std::vector<Vec3f> m_gape, m_gape_next;  ///< (nodes) [m]
  std::vector<float> m_gape_weight;
  CutShape m_shape;
  std::vector<Vec3f> m_drips;
  render::Liquid m_ooze;  ///< what runs from it, made again when it moves
  tissue::Box m_box;
  bool m_dented = false, m_burnt = false;
  Moved m_moved;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
