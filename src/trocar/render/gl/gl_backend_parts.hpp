// The backend that draws, in seven files: the list of passes (gl_backend.cpp), what draws things into the
// scene picture (gl_scene_passes.cpp), how instruments shade it (gl_rods.cpp), liquids and smoke in it
// (gl_liquid_passes.cpp, gl_smoke_pass.cpp), what makes a camera's picture of it (gl_picture_passes.cpp), and what is
// where, without light (gl_layers_pass.cpp). Private to them.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include <epoxy/gl.h>

#include <trocar/render/backend/checked_backend.hpp>
#include <trocar/render/backend/packing.hpp>
#include <trocar/render/gl/gl_meshes.hpp>
#include <trocar/render/gl/gl_pass_timer.hpp>
#include <trocar/render/gl/gl_program.hpp>
#include <trocar/render/gl/gl_targets.hpp>

namespace trocar::render {

enum TextureUnit : int {
  kUnitPicture = 0,
  kUnitNoise = 1,
  kUnitCells = 2,
  kUnitVessels = 3,
  kUnitSmall = 4,
  kUnitSmaller = 5,
  kUnitExposure = 6,
  kUnitArcade = 7,
  kUnitShade = 8,
  kUnitBed = 9,   // the scene below a liquid
  kUnitWet = 10,  // and the two after it
  kUnitLining = 13
};

inline void bind_texture(int unit, GLenum target, GLuint texture) {
  glActiveTexture(GLenum(GL_TEXTURE0 + unit));
  glBindTexture(target, texture);
}

class GlBackend final : public CheckedBackend {
 public:
  explicit GlBackend(GlContext& context);

 private:
  static constexpr int kEyes = 8;
  // Bits of the scene's stencil: what shows there.
  static constexpr GLint kStencilMetal = 1, kStencilPool = 2, kStencilWet = 4;

  void on_store(std::uint32_t id, const MeshArrays& mesh) override { m_meshes.store(id, mesh); }
  void on_update(std::uint32_t id, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                 std::span<const Paint> paint) override {
    m_meshes.update(id, positions, normals, paint);
  }
  void on_destroy(std::uint32_t id) override { m_meshes.destroy(id); }

  /// Draws each item once at every detail, clean and stained, into a picture of a few pixels.
  void on_prepare(std::span<const DrawItem> items) override;
  void on_prepare_liquids() override;
  void on_frame(const Frame& frame, const Target& target, std::span<const DrawItem* const> opaque,
                std::span<const DrawItem* const> translucent) override;
  void on_keep_eye(Eye eye, const Target& from) override;
  void on_combine(StereoMode mode, const Target& target) override;
  Image on_read(const Target& target) override;
  RawLayers on_layers(const Frame& frame, std::span<const DrawItem* const> items, const Camera& before, int width,
                      int height) override;
  void on_remember(std::span<const DrawItem* const> items) override;

  void begin_layers(const Frame& frame, const Target& target, const Layout& layout);
  void layer_items(std::span<const DrawItem* const> items, const Mat4& view_before);
  void layer_liquids(const Frame& frame, const Layout& layout);

  /// A frame on its way through the passes.
  struct Drawing {
    const Frame& frame;
    const Target& target;
    const Layout layout;
    std::span<const DrawItem*const> opaque, translucent;
  };
  struct Pass {
    const char* name;
    void (*run)(GlBackend&, const Drawing&);
  };
  static std::span<const Pass> passes();

  void begin_scene(const Frame& frame, const Target& target, const Layout& layout);
  /// Near depth outside the circle, so that early depth tests drop those pixels.
  void mask_pass(const Layout& layout);
  /// Translucent things and smoke: premultiplied light over what is there; alpha keeps the opaque distance.
  static void set_blending(bool on);
  /// Metal is marked in the stencil: instruments do not shade themselves.
  void scene_pass(const Frame& frame, std::span<const DrawItem* const> items, bool blended);
  void before_pool_pass(const Frame& frame, std::span<const DrawItem* const> translucent);
  void draw_edges(const DrawItem& item);
  void draw_item(const Frame& frame, const DrawItem& item, bool blended, bool stained);
  GlProgram& program_for(const Frame& frame, const Material& material, int detail, bool blended, bool stained);
  void puff_pass(const Frame& frame);

  /// What lies below a liquid, kept while the liquid is drawn over it. Only the part of the scene in `m_wet_box`.
  void keep_bed();
  /// The sheet: refracts what lies below, mirrors what is around; writes depth and distance.
  void sheet_pass(const Frame& frame, const Layout& layout);
  /// Drops and films, added up at half the scene's size; then their surface, drawn over the scene.
  void splat_pass(const Frame& frame, const Layout& layout);
  /// Into m_splat_rows, in the eye's frame; m_wet_box holds them all. Those that cannot be seen are left out.
  /// @param field_height  of the picture that they are drawn into [px]
  void pack_splats(const Frame& frame, int field_height);
  void bind_sheet(const Liquid& liquid);
  void bind_splats();
  GLsizei splat_count() const;
  /// The parts of the scene that splats reach, as rectangles: a software driver pays for every pixel it looks at.
  void mark_tiles(const std::array<int, 4>& box);
  void pack_tiles();
  void wet_pass(const Frame& frame, const Layout& layout);
  void mark_pool(GLsizei count);
  void mark_wet();
  void bind_tiles();
  void draw_tiles() const;
  void set_liquid(const Frame& frame, GlProgram& program);
  /// Marches through the smoke at a fifth of the scene's size or less.
  void smoke_pass(const Frame& frame);
  void set_smoke(const SmokeVolume& smoke, GlProgram& program);
  /// Blurred copies of the developed picture, for a lens that is not clean.
  void soil_pass();
  void set_soil(const LensSoil& soil, std::uint64_t tick, GlProgram& program);

  /// Rods in the eye's frame, as rows of u_rods: one end and the radius, the way to the other end and 1 / its square.
  void pack_rods(const Frame& frame);
  /// Only the rods that come near a fold: each costs at every one of its pixels.
  void set_rods_near(const Frame& frame, const DrawItem& item, GlProgram& program);
  /// The corners, in clip space, of what a rod may shade: around its picture, and as far as its shadow may lie off it.
  std::array<float, 8> reach_of(int rod, float aspect, float tan_half) const;
  /// What instruments leave of the light on opaque surfaces, each over the part of the picture that it may shade.
  void shade_pass(const Frame& frame, const Layout& layout);

  void resample(const GlPicture& from, GlPicture& to, const char* spread);
  /// A quarter as wide and high, then smoothed, so that enlarging it shows no steps.
  void shrink(const GlPicture& from, GlPicture& rough, GlPicture& smooth, GLenum format = GL_RGBA16F);
  void resolve_pass(const Frame& frame);
  void shrink_pass();
  /// Exposure lives in two pictures of one pixel an eye; this reads one and writes the other.
  void meter_pass(const Frame& frame, const Target& target, const Layout& layout);
  void develop_pass(const Frame& frame, const Target& target, const Layout& layout);
  void lens_pass(const Frame& frame, const Target& target, const Layout& layout);
  void draw_full();
  /// Only the endoscope's circle of a picture that it is centred in; without a mask all of it.
  void draw_view(GlProgram& program, const EndoscopeLook& look, float radius, float width, float height);

  void bind_target(const Target& target);
  /// Others draw into the same context (menus): leave nothing bound that they would trip over.
  void leave_state_clean();

  struct LayerPictures {
    GlPicture surface, places;  ///< the first one's framebuffer draws into both
    void resize(int width, int height);
  };
  struct SeenPuff {
    Vec3f eye;
    const Puff* puff;
  };
  struct Memory {
    int current = 0;         ///< which of m_exposure holds this eye's value
    std::uint64_t tick = 0;  ///< when it was written
    bool known = false;
  };

  GlContext& m_context;
  GlMeshes m_meshes;
  GlPrograms m_programs;
  GlTexture m_noise, m_cells, m_vessels, m_arcade, m_lining;
  GlVertexArray m_no_vertices;
  GlSampledPicture m_sampled;
  GlPicture m_scene, m_shade, m_small, m_smaller, m_developed, m_own, m_left, m_right, m_bed, m_smoke;
  std::array<GlPicture, 3> m_blur_rough, m_blur;
  std::array<GlPicture, 3> m_wet;  ///< field, thickness, film; the first one's framebuffer draws into all of them
  GlVertexArray m_splat_layout, m_sheet_layout, m_tile_layout;
  GlBuffer m_splat_buffer, m_sheet_buffer, m_sheet_indices, m_tile_buffer;
  GlTexture m_smoke_grid;
  std::array<int, 3> m_smoke_size{};
  bool m_smokes = false;  ///< in this frame
  std::vector<float> m_splat_rows, m_tile_rows;
  std::vector<std::uint8_t> m_wet_tiles;
  std::vector<std::uint8_t> m_smoke_bytes;
  std::array<int, 4> m_wet_box{};  ///< of the scene picture [px]: x, y, width, height
  LayerPictures m_layers;
  std::unordered_map<std::uint32_t, std::vector<Mat4>> m_transforms_before;  ///< of a mesh's items, in turn
  std::array<GlPicture, 2> m_rough, m_exposure;
  std::array<Memory, kEyes> m_memory;
  Mat4 m_view, m_projection;
  float m_shift = 0;  ///< of the frame's camera
  std::array<float, 8 * 4> m_frame_rows{};
  std::array<float, 8 * kMaxRods> m_rod_rows{};
  int m_rod_count = 0;
  std::vector<SeenPuff> m_puffs;
  GlPassTimer m_timer;
  int m_small_eye = -1;  ///< whose picture m_small holds
};

}  // namespace trocar::render
