// The half that all backends share: it keeps the books (which meshes live, is a frame open), refuses misuse, counts,
// and hands what is left to hooks. The null backend is this class with empty hooks, so what passes there passes in GL.
#pragma once

#include <unordered_map>
#include <vector>

#include <trocar/render/backend/backend.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>

namespace trocar::render {

class CheckedBackend : public Backend {
 public:
  MeshHandle create_mesh(const MeshData& data) final;
  void update_mesh(MeshHandle mesh, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                   std::span<const Paint> paint) final;
  void replace_mesh(MeshHandle mesh, const MeshData& data) final;
  void destroy_mesh(MeshHandle mesh) final;
  void prepare(std::span<const DrawItem> items) final;
  void prepare_liquids() final;
  void begin_frame(const Frame& frame, const Target& target) final;
  void draw(const DrawItem& item) final;
  void end_frame() final;
  void keep_eye(Eye eye, const Target& from) final;
  void combine(StereoMode mode, const Target& target) final;
  Layers draw_layers(const Frame& frame, const Camera& before, int width, int height) final;
  void remember(const Frame& frame) final;
  void profile(std::vector<PassCost>* costs) final;
  Image read_pixels() final;
  BackendStats stats() const final { return m_stats; }

 protected:
  /// Whether any vertex's paint says blood or burn: the plainer shader does for the others.
  bool is_stained(MeshHandle mesh) const { return m_meshes.at(mesh.id).stained; }

  /// Of the mesh as it is now, in its own coordinates.
  const Bounds& bounds_of_mesh(MeshHandle mesh) const { return m_meshes.at(mesh.id).bounds; }

  /// Of the mesh, as it was given.
  std::span<const std::uint32_t> indices_of_mesh(MeshHandle mesh) const { return m_meshes.at(mesh.id).indices; }

  /// Where the passes' costs go; null: nobody asks.
  std::vector<PassCost>* costs() const { return m_costs; }

  virtual void on_store(std::uint32_t id, const MeshArrays& mesh) = 0;  ///< new id, or a known one's new topology
  virtual void on_update(std::uint32_t id, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                         std::span<const Paint> paint) = 0;  ///< paint may be empty
  virtual void on_destroy(std::uint32_t id) = 0;
  virtual void on_prepare(std::span<const DrawItem> items) = 0;
  virtual void on_prepare_liquids() = 0;
  /// @param opaque near to far (less is shaded twice), translucent far to near
  virtual void on_frame(const Frame& frame, const Target& target, std::span<const DrawItem* const> opaque,
                        std::span<const DrawItem* const> translucent) = 0;
  virtual void on_keep_eye(Eye eye, const Target& from) = 0;
  virtual void on_combine(StereoMode mode, const Target& target) = 0;
  virtual RawLayers on_layers(const Frame& frame, std::span<const DrawItem* const> items, const Camera& before,
                              int width, int height) = 0;
  virtual void on_remember(std::span<const DrawItem* const> items) = 0;
  virtual Image on_read(const Target& target) = 0;

 private:
  struct Known {
    std::size_t vertices = 0;
    std::vector<std::uint32_t> indices;
    std::vector<std::size_t> triangles;  ///< of each level
    Primitive primitive = Primitive::triangles;
    Bounds bounds;
    bool stained = false;  ///< some paint says blood or burn
  };
  struct Sorted {
    float depth;
    const DrawItem* item;
  };
  Known& known(MeshHandle mesh, const char* call);
  void store(std::uint32_t id, const MeshData& data);
  void sort_items();
  /// Those with a surface: not ghosts, edges or lines.
  std::span<const DrawItem* const> solid_items(const Frame& frame, const char* call);

  std::unordered_map<std::uint32_t, Known> m_meshes;  // looked up by id only, never iterated
  std::uint32_t m_next_id = 1;
  bool m_in_frame = false, m_has_picture = false;
  Frame m_frame;
  Target m_target, m_left, m_right;  ///< eyes: 0 wide until kept
  std::vector<DrawItem> m_items;
  std::vector<const DrawItem*> m_opaque, m_translucent;
  std::vector<Sorted> m_order;
  std::vector<Vec3f> m_normals;
  BackendStats m_stats;
  std::vector<PassCost>* m_costs = nullptr;
};

}  // namespace trocar::render
