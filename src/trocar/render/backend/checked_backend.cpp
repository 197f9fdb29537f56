#include <algorithm>
#include <cmath>
#include <string>

#include <trocar/render/backend/checked_backend.hpp>

namespace trocar::render {

namespace {

void require(bool good, const char* call, const std::string& what) {
  if (!good) throw Misuse(std::string(call) + ": " + what);
}

bool finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require_finite(std::span<const Vec3f> array, const char* call, const char* name) {
  for (std::size_t i = 0; i < array.size(); ++i)
    if (!finite(array[i])) throw Misuse(std::string(call) + ": " + name + "[" + std::to_string(i) + "] is not finite");
}

void require_size(std::size_t size, std::size_t n, const char* call, const char* name) {
  require(size == 0 || size == n, call,
          std::string(name) + " has " + std::to_string(size) + " entries for " + std::to_string(n) + " vertices");
}

void require_indices(std::span<const std::uint32_t> indices, std::size_t corners, std::size_t n, const char* call) {
  require(!indices.empty() && indices.size() % corners == 0, call,
          std::to_string(indices.size()) + " indices are not a whole number of " +
              (corners == 3 ? "triangles" : "lines") + " (or none)");
  for (std::size_t i = 0; i < indices.size(); ++i)
    require(indices[i] < n, call,
            "indices[" + std::to_string(i) + "] = " + std::to_string(indices[i]) + " with only " + std::to_string(n) +
                " vertices");
}

void check_mesh(const MeshData& data, const char* call) {
  const std::size_t n = data.positions.size();
  require(n > 0, call, "a mesh needs at least one vertex");
  require_size(data.normals.size(), n, call, "normals");
  require_size(data.rest.size(), n, call, "rest");
  require_size(data.paint.size(), n, call, "paint");
  require_finite(data.positions, call, "positions");
  require_finite(data.normals, call, "normals");
  require_finite(data.rest, call, "rest");
  const std::size_t corners = data.primitive == Primitive::triangles ? 3 : 2;
  require_indices(data.indices, corners, n, call);
  require(data.coarser.empty() || corners == 3, call, "only triangles have coarser lists");
  for (const std::vector<std::uint32_t>& list : data.coarser) require_indices(list, corners, n, call);
}

void check_camera(const Camera& camera, const char* call) {
  require(finite(camera.position), call, "camera position is not finite");
  for (int j = 0; j < 3; ++j) {
    const float size = length(camera.rotation.column(j));
    require(std::fabs(size - 1) < 1e-3f, call, "camera rotation is not a rotation");
  }
  require(camera.vertical_fov > 0.01f && camera.vertical_fov < 3.0f, call, "vertical fov is not within 0.01..3 rad");
  require(std::fabs(camera.shift) < 10, call, "camera shift is not within -10..10");
  require(camera.near_plane > 0 && camera.far_plane > camera.near_plane && std::isfinite(camera.far_plane), call,
          "0 < near < far does not hold");
}

void check_soil(const LensSoil& soil, const char* call) {
  const auto share = [](float x) { return x >= 0 && x <= 1; };
  require(share(soil.fog) && share(soil.smear) && soil.wipe <= 1 && std::isfinite(soil.smear_angle), call,
          "what is on the lens is not within 0..1");
  require(soil.drop_count >= 0 && soil.drop_count <= LensSoil::kMaxDrops, call, "too many drops on the lens");
  for (int i = 0; i < soil.drop_count; ++i) {
    const LensDrop& drop = soil.drops[std::size_t(i)];
    require(std::isfinite(drop.x) && std::isfinite(drop.y) && drop.radius > 0 && finite(drop.tint), call,
            "a drop on the lens is not finite");
  }
}

bool lies(SplatKind kind) { return kind == SplatKind::lying || kind == SplatKind::film; }

void check_splat(const Splat& splat, std::size_t i, const char* call) {
  const std::string name = "splat " + std::to_string(i);
  require(finite(splat.from) && finite(splat.to), call, name + " is not finite");
  require(splat.radius > 0 && std::isfinite(splat.radius), call, name + " has no radius");
  require(splat.height >= 0 && std::isfinite(splat.height), call, name + " has no height");
  float shares = 0;
  for (const float share : splat.share) {
    require(share >= 0, call, name + " holds less than nothing");
    shares += share;
  }
  require(shares <= 1.001f, call, name + " holds more than all");
  require(!lies(splat.kind) || std::fabs(length(splat.normal) - 1) < 1e-2f, call,
          name + " lies on a surface without a unit normal");
}

void check_liquid(const Liquid& liquid, const char* call) {
  for (std::size_t i = 0; i < liquid.splats.size(); ++i) check_splat(liquid.splats[i], i, call);
  for (std::size_t i = 0; i < liquid.sheet.size(); ++i) {
    const SheetVertex& v = liquid.sheet[i];
    require(finite(v.position) && finite(v.normal) && std::isfinite(v.depth) && std::isfinite(v.cover) &&
                std::isfinite(v.share_b) && std::isfinite(v.share_c) && std::isfinite(v.froth) && std::isfinite(v.dark),
            call, "sheet vertex " + std::to_string(i) + " is not finite");
  }
  require(liquid.triangles.size() % 3 == 0, call, "the sheet's indices are not a whole number of triangles");
  for (const std::uint32_t index : liquid.triangles)
    require(index < liquid.sheet.size(), call,
            "the sheet's index " + std::to_string(index) + " with only " + std::to_string(liquid.sheet.size()) +
                " vertices");
  for (const LiquidLook::Kind& kind : liquid.look.kinds)
    require(finite(kind.absorbs) && finite(kind.deep), call, "a liquid's colour is not finite");
}

void check_smoke(const SmokeVolume& smoke, const char* call) {
  if (smoke.empty()) return;
  require(smoke.nx > 0 && smoke.ny > 0 && smoke.nz > 0 && smoke.nx <= 256 && smoke.ny <= 256 && smoke.nz <= 256, call,
          "smoke has a grid of " + std::to_string(smoke.nx) + " x " + std::to_string(smoke.ny) + " x " +
              std::to_string(smoke.nz));
  require(smoke.density.size() == std::size_t(smoke.nx) * smoke.ny * smoke.nz, call,
          "smoke has " + std::to_string(smoke.density.size()) + " densities for its grid");
  require(finite(smoke.origin) && finite(smoke.up) && smoke.cell > 0 && smoke.kappa >= 0, call, "smoke is not finite");
  for (const float density : smoke.density)
    require(density >= 0 && std::isfinite(density), call, "smoke has a density that cannot be");
}

void check_frame(const Frame& frame, const Target& target, const char* call) {
  require(target.width > 0 && target.height > 0 && target.width <= 16384 && target.height <= 16384, call,
          "target size " + std::to_string(target.width) + " x " + std::to_string(target.height));
  check_camera(frame.camera, call);
  require(frame.quality.render_scale >= 0.25f && frame.quality.render_scale <= 1, call,
          "render scale is not within 0.25..1");
  require(frame.quality.detail >= 0 && frame.quality.detail <= 2, call, "detail is not 0, 1 or 2");
  require(frame.quality.coarser > 0, call, "coarser is not above 0");
  require(frame.eye >= 0 && frame.eye < 8, call, "eye is not within 0..7");
  const Light& light = frame.light;
  require(
      finite(light.position) && finite(light.colour) && std::isfinite(light.intensity) && light.reference_distance > 0,
      call, "light is not finite");
  const EndoscopeLook& look = frame.look;
  require(look.mask_diameter > 0 && std::isfinite(look.exposure_ev) && look.exposure_seconds > 0 && look.fog >= 0 &&
              look.focus > 0 && look.aperture >= 0,
          call, "look holds a value out of range");
  for (const Puff& puff : frame.puffs)
    require(finite(puff.centre) && puff.radius > 0 && std::isfinite(puff.density), call, "a puff is not finite");
  check_soil(look.soil, call);
  check_liquid(frame.liquid, call);
  check_smoke(frame.smoke, call);
}

void check_material(const Material& m, const char* call) {
  require(finite(m.colour) && finite(m.colour_b) && finite(m.colour_c) && finite(m.tint), call,
          "a material colour is not finite");
  require(m.mottle_size > 0 && m.film_size > 0 && m.vessel_tile > 0 && m.lobule_size >= 0, call,
          "a material length is not positive");
  require(m.roughness > 0 && m.film_roughness > 0, call, "a material roughness is not positive");
  require(m.alpha >= 0 && m.alpha <= 1 && m.rim_alpha >= 0 && m.rim_alpha <= 1, call, "alpha is not within 0..1");
  require(m.fibre_stretch >= 1 && std::fabs(length(m.fibre_axis) - 1) < 1e-3f, call,
          "fibre axis is not a unit vector, or its stretch is below 1");
}

bool any_stain(std::span<const Paint> paint) {
  return std::any_of(paint.begin(), paint.end(), [](Paint p) { return p.blood > 0 || p.burn > 0; });
}

/// What the camera can have in its picture.
class Sight {
 public:
  Sight(const Frame& frame, const Target& target)
      : m_camera(frame.camera),
        m_high(std::tan(frame.camera.vertical_fov / 2)),
        m_wide(m_high * float(target.width) / float(target.height) + std::fabs(frame.camera.shift)) {}

  /// False only where all of the box lies beyond one side of the view.
  bool reaches(const Bounds& box, const Mat4& transform) const {
    int left = 0, right = 0, above = 0, below = 0, behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f p{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                    corner & 4 ? box.high.z : box.low.z};
      const Vec3f eye = transposed(m_camera.rotation) * (transform_point(transform, p) - m_camera.position);
      left += eye.x < m_wide * eye.z;
      right += eye.x > -m_wide * eye.z;
      below += eye.y < m_high * eye.z;
      above += eye.y > -m_high * eye.z;
      behind += eye.z > -m_camera.near_plane;
    }
    return left < 8 && right < 8 && below < 8 && above < 8 && behind < 8;
  }

 private:
  const Camera& m_camera;
  float m_high, m_wide;  ///< tangents
};

}  // namespace

void draw_frame(Backend& backend, const Frame& frame, const Target& target) {
  backend.begin_frame(frame, target);
  for (const DrawItem& item : frame.items) backend.draw(item);
  backend.end_frame();
}

CheckedBackend::Known& CheckedBackend::known(MeshHandle mesh, const char* call) {
  const auto found = m_meshes.find(mesh.id);
  require(found != m_meshes.end(), call, "mesh " + std::to_string(mesh.id) + " does not exist (any more)");
  return found->second;
}

void CheckedBackend::store(std::uint32_t id, const MeshData& data) {
  Known& mesh = m_meshes[id];
  mesh.vertices = data.positions.size();
  mesh.indices.assign(data.indices.begin(), data.indices.end());
  mesh.triangles = {data.indices.size() / 3};
  for (const std::vector<std::uint32_t>& list : data.coarser) mesh.triangles.push_back(list.size() / 3);
  mesh.primitive = data.primitive;
  mesh.bounds = bounds_of(data.positions);
  mesh.stained = any_stain(data.paint);
  m_stats.vertices_uploaded += mesh.vertices;
  on_store(id, complete(data));
}

MeshHandle CheckedBackend::create_mesh(const MeshData& data) {
  const char* call = "create_mesh";
  require(!m_in_frame, call, "a frame is open");
  check_mesh(data, call);
  const std::uint32_t id = m_next_id++;
  store(id, data);
  ++m_stats.meshes_alive;
  return {id};
}

void CheckedBackend::update_mesh(MeshHandle handle, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                 std::span<const Paint> paint) {
  const char* call = "update_mesh";
  require(!m_in_frame, call, "a frame is open");
  Known& mesh = known(handle, call);
  require(positions.size() == mesh.vertices, call,
          std::to_string(positions.size()) + " positions for " + std::to_string(mesh.vertices) + " vertices");
  require_size(normals.size(), mesh.vertices, call, "normals");
  require_size(paint.size(), mesh.vertices, call, "paint");
  require_finite(positions, call, "positions");
  require_finite(normals, call, "normals");
  if (normals.empty()) {
    const std::span<const std::uint32_t> none;
    vertex_normals(positions, mesh.primitive == Primitive::triangles ? mesh.indices : none, m_normals);
    normals = m_normals;
  }
  mesh.bounds = bounds_of(positions);
  if (!paint.empty()) mesh.stained = any_stain(paint);
  m_stats.vertices_uploaded += mesh.vertices;
  on_update(handle.id, positions, normals, paint);
}

void CheckedBackend::replace_mesh(MeshHandle handle, const MeshData& data) {
  const char* call = "replace_mesh";
  require(!m_in_frame, call, "a frame is open");
  known(handle, call);
  check_mesh(data, call);
  store(handle.id, data);
}

void CheckedBackend::destroy_mesh(MeshHandle handle) {
  const char* call = "destroy_mesh";
  require(!m_in_frame, call, "a frame is open");
  known(handle, call);
  m_meshes.erase(handle.id);
  --m_stats.meshes_alive;
  on_destroy(handle.id);
}

void CheckedBackend::prepare(std::span<const DrawItem> items) {
  const char* call = "prepare";
  require(!m_in_frame, call, "a frame is open");
  for (const DrawItem& item : items) {
    known(item.mesh, call);
    check_material(item.material, call);
  }
  on_prepare(items);
}

void CheckedBackend::prepare_liquids() {
  require(!m_in_frame, "prepare_liquids", "a frame is open");
  on_prepare_liquids();
}

void CheckedBackend::begin_frame(const Frame& frame, const Target& target) {
  const char* call = "begin_frame";
  require(!m_in_frame, call, "the frame before was not ended");
  check_frame(frame, target, call);
  m_in_frame = true;
  m_target = target;
  m_items.clear();
  m_frame.camera = frame.camera;
  m_frame.light = frame.light;
  m_frame.look = frame.look;
  m_frame.quality = frame.quality;
  m_frame.puffs = frame.puffs;
  m_frame.rods = frame.rods;
  m_frame.liquid = frame.liquid;
  m_frame.smoke = frame.smoke;
  m_frame.background = frame.background;
  m_frame.tick = frame.tick;
  m_frame.eye = frame.eye;
  m_frame.metering = frame.metering;
}

void CheckedBackend::draw(const DrawItem& item) {
  const char* call = "draw";
  require(m_in_frame, call, "no frame is open");
  const Known& mesh = known(item.mesh, call);
  require(is_finite(item.transform), call, "transform is not finite");
  check_material(item.material, call);
  m_items.push_back(item);
  ++m_stats.items;
  require(item.detail <= 2, call, "detail is not 0, 1 or 2");
  if (mesh.primitive == Primitive::triangles)
    m_stats.triangles += mesh.triangles[std::min<std::size_t>(item.level, mesh.triangles.size() - 1)];
}

void CheckedBackend::sort_items() {
  const Vec3f backward = m_frame.camera.rotation.column(2);
  const Sight sight(m_frame, m_target);
  const auto sorted = [&](bool translucent, std::vector<const DrawItem*>& out) {
    m_order.clear();
    for (const DrawItem& item : m_items) {
      if (item.blends() != translucent) continue;
      const Bounds& bounds = m_meshes.at(item.mesh.id).bounds;
      if (!sight.reaches(bounds, item.transform)) continue;
      const Vec3f middle = transform_point(item.transform, bounds.middle());
      float depth = dot(backward, m_frame.camera.position - middle);
      // What encloses the scene reaches farthest and comes last; the middle says best what lies on what.
      if (!translucent) depth += 0.5f * length(transform_direction(item.transform, bounds.high - bounds.low));
      if (translucent) depth -= item.nearer;
      m_order.push_back({translucent ? -depth : depth, &item});
    }
    std::stable_sort(m_order.begin(), m_order.end(), [](Sorted a, Sorted b) { return a.depth < b.depth; });
    out.clear();
    for (const Sorted& s : m_order) out.push_back(s.item);
  };
  sorted(false, m_opaque);
  sorted(true, m_translucent);
}

void CheckedBackend::end_frame() {
  require(m_in_frame, "end_frame", "no frame is open");
  m_in_frame = false;
  sort_items();
  on_frame(m_frame, m_target, m_opaque, m_translucent);
  m_has_picture = true;
  ++m_stats.frames;
  m_stats.puffs += m_frame.puffs.size();
  m_stats.splats += m_frame.liquid.splats.size();
  m_stats.sheet_triangles += m_frame.liquid.triangles.size() / 3;
}

void CheckedBackend::keep_eye(Eye eye, const Target& from) {
  const char* call = "keep_eye";
  require(!m_in_frame, call, "a frame is open");
  require(from.width > 0 && from.height > 0, call, "an empty target");
  const bool own = from.framebuffer == Target::kOwnBuffer;
  require(!own || (m_has_picture && m_target.framebuffer == from.framebuffer && m_target.width == from.width &&
                   m_target.height == from.height),
          call, "this is not what was drawn last");
  on_keep_eye(eye, from);
  (eye == Eye::left ? m_left : m_right) = from;
}

void CheckedBackend::combine(StereoMode mode, const Target& target) {
  const char* call = "combine";
  require(!m_in_frame, call, "a frame is open");
  require(m_left.width > 0 && m_right.width > 0, call, "both eyes' pictures must be kept first");
  require(m_left.width == m_right.width && m_left.height == m_right.height, call,
          "the eyes' pictures are not of one size");
  require(target.width > 0 && target.height > 0, call, "an empty target");
  require(mode != StereoMode::quad_buffer || target.framebuffer == 0, call, "only a window has quad buffers");
  on_combine(mode, target);
  m_target = target;
  m_left = m_right = {};
}

std::span<const DrawItem* const> CheckedBackend::solid_items(const Frame& frame, const char* call) {
  require(!m_in_frame, call, "a frame is open");
  m_opaque.clear();
  for (const DrawItem& item : frame.items) {
    require(is_finite(item.transform), call, "transform is not finite");
    if (known(item.mesh, call).primitive == Primitive::triangles && item.style == DrawStyle::shaded)
      m_opaque.push_back(&item);
  }
  return m_opaque;
}

Layers CheckedBackend::draw_layers(const Frame& frame, const Camera& before, int width, int height) {
  const char* call = "draw_layers";
  check_frame(frame, Target::off_screen(width, height), call);
  check_camera(before, call);
  const std::span<const DrawItem* const> items = solid_items(frame, call);
  return through_lens(on_layers(frame, items, before, width, height),
                      Projection(frame.camera, frame.look, width, height),
                      Projection(before, frame.look, width, height), width, height);
}

void CheckedBackend::remember(const Frame& frame) { on_remember(solid_items(frame, "remember")); }

void CheckedBackend::profile(std::vector<PassCost>* costs) {
  require(!m_in_frame, "profile", "a frame is open");
  m_costs = costs;
}

Image CheckedBackend::read_pixels() {
  require(!m_in_frame, "read_pixels", "a frame is open");
  require(m_has_picture, "read_pixels", "no frame was drawn yet");
  return on_read(m_target);
}

}  // namespace trocar::render
