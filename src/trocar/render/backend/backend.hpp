// The renderer's contract: meshes live in a backend, a frame is begun, items are drawn into it, and it is ended into a
// target. GlBackend draws; NullBackend only checks and counts. Both refuse the same misuse with Misuse.
//
//   auto context = GlContext::off_screen();
//   auto backend = make_gl_backend(*context);
//   draw_frame(*backend, frame, Target::off_screen(800, 600));
//   write_png("a.png", backend->read_pixels());
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include <trocar/render/backend/layers.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/render/frame/image.hpp>
#include <trocar/render/frame/mesh_data.hpp>
#include <trocar/render/frame/pass_cost.hpp>
#include <trocar/render/frame/stereo.hpp>

namespace trocar::render {

/// A programmer's mistake in calling a backend: which call, what was wrong.
class Misuse : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

struct BackendStats {
  std::uint64_t frames = 0, items = 0, triangles = 0, puffs = 0;  ///< drawn since the start
  std::uint64_t splats = 0, sheet_triangles = 0;                  ///< of liquids
  std::uint64_t vertices_uploaded = 0;
  std::uint32_t meshes_alive = 0;
};

class Backend {
 public:
  virtual ~Backend() = default;

  virtual MeshHandle create_mesh(const MeshData& data) = 0;
  /// New positions, and normals and paint where not empty; all (n) as at creation. Not between begin and end.
  /// Normals left empty are computed from the triangles.
  virtual void update_mesh(MeshHandle mesh, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                           std::span<const Paint> paint) = 0;
  /// Another topology under the same handle (after a cut).
  virtual void replace_mesh(MeshHandle mesh, const MeshData& data) = 0;
  virtual void destroy_mesh(MeshHandle mesh) = 0;

  /// Makes ready what these items will need at every quality, clean and stained: a shader that is first used in the
  /// middle of an operation costs 0.1 s there and then. Optional; once, after the meshes are made.
  virtual void prepare(std::span<const DrawItem> items) = 0;
  /// The same for liquids, smoke and what may be on the lens: for scenes that may have them.
  virtual void prepare_liquids() = 0;

  /// Takes everything of the frame but its items.
  virtual void begin_frame(const Frame& frame, const Target& target) = 0;
  virtual void draw(const DrawItem& item) = 0;
  virtual void end_frame() = 0;

  /// Keeps what a target shows, from any source, as one eye's picture.
  virtual void keep_eye(Eye eye, const Target& from) = 0;
  /// Puts the pictures of both eyes together. Both, and of one size, must have been kept since the last time. Quad
  /// buffers need a window with them.
  virtual void combine(StereoMode mode, const Target& target) = 0;

  /// What the frame's picture shows where (layers.hpp). Things that are shown transparent or as edges are left out, and
  /// smoke; drops have their own outlines each. Draws into pictures of its own.
  /// @param before  the remembered frame's camera
  virtual Layers draw_layers(const Frame& frame, const Camera& before, int width, int height) = 0;
  /// Keeps where the frame's things are now, for the flow of later draw_layers().
  virtual void remember(const Frame& frame) = 0;

  /// From now on each frame adds what its passes cost to `costs`, in their order, and waits for the driver between
  /// them: for measuring only. Null ends that. A backend that does not draw adds nothing.
  virtual void profile(std::vector<PassCost>* costs) = 0;

  /// The target of the last frame.
  virtual Image read_pixels() = 0;
  virtual BackendStats stats() const = 0;
};

/// begin_frame, draw every item, end_frame.
void draw_frame(Backend& backend, const Frame& frame, const Target& target);

class GlContext;
/// @param context must stay alive and current while the backend is used
std::unique_ptr<Backend> make_gl_backend(GlContext& context);
std::unique_ptr<Backend> make_null_backend();

}  // namespace trocar::render
