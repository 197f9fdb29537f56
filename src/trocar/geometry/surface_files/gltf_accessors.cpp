#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/gltf_accessors.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

/// How a component stands in a buffer, little-endian.
struct GltfType {
  std::size_t number;  ///< as componentType says it
  int width;
  bool whole, is_signed;
  double full;  ///< what stands for 1 where it is normalized
};
constexpr GltfType kGltfTypes[] = {{5120, 1, true, true, 127},           {5121, 1, true, false, 255},
                                   {5122, 2, true, true, 32767},         {5123, 2, true, false, 65535},
                                   {5125, 4, true, false, 4294967295.0}, {5126, 4, false, true, 1}};

double component(const char* bytes, const GltfType& type) {
  if (!type.whole) {
    float value = 0;
    std::memcpy(&value, bytes, 4);
    return double(value);
  }
  std::uint32_t value = 0;
  for (int k = 0; k < type.width; ++k) value |= std::uint32_t(static_cast<unsigned char>(bytes[k])) << (8 * k);
  const double most = type.width == 1 ? 256.0 : 65536.0;
  return type.is_signed && double(value) > type.full ? double(value) - most : double(value);
}

class GltfAccessor {
 public:
  GltfAccessor(GltfDocument& gltf, GltfItem item) : m_gltf(gltf), m_item(item) {}

  /// All components, one item after the other.
  std::optional<std::vector<double>> read(const char* type, int components) {
    m_components = components;
    const GltfItem type_item = m_gltf.member(m_item, "type");
    if (!type_item || type_item->text != type)
      return refuse(tr("expected an accessor of type {}, got {}", type, m_gltf.shown(type_item)));
    m_type = component_type(m_item);
    const std::optional<std::size_t> count = m_gltf.whole(m_item, "count");
    if (!m_type || !count) return refuse("expected an accessor with componentType and count, got another one");
    bound_items(m_gltf.in(), *count / std::size_t(components == 1 ? 3 : 1), "items of an accessor");
    const GltfItem sparse = m_gltf.member(m_item, "sparse"), view = m_gltf.named(m_item, "bufferView", "bufferViews");
    const bool has_view = m_gltf.member(m_item, "bufferView") != nullptr;
    if (has_view && !view) return std::nullopt;
    if (!has_view && !sparse) return refuse("expected an accessor with a bufferView or sparse, got one without");
    std::vector<double> values(*count * std::size_t(components));  // zeros, where only sparse says what there is
    if (has_view && !take(view, m_gltf.whole(m_item, "byteOffset").value_or(0), *count, values)) return std::nullopt;
    if (sparse && !replace(sparse, *count, values)) return std::nullopt;
    normalise(values);
    return values;
  }
  const GltfType& type() const { return *m_type; }

 private:
  GltfDocument& m_gltf;
  GltfItem m_item;
  int m_components = 0;
  const GltfType* m_type = nullptr;

  std::nullopt_t refuse(std::string message) {
    m_gltf.fault(m_item, std::move(message));
    return std::nullopt;
  }

  const GltfType* component_type(GltfItem of) {
    const std::optional<std::size_t> number = m_gltf.whole(of, "componentType");
    const auto found = std::find_if(std::begin(kGltfTypes), std::end(kGltfTypes),
                                    [&](const GltfType& t) { return number && t.number == *number; });
    return found == std::end(kGltfTypes) ? nullptr : found;
  }

  bool take(GltfItem view, std::size_t offset, std::size_t count, std::vector<double>& values) {
    const std::optional<std::string_view> bytes = m_gltf.view(view, offset);
    if (!bytes) return false;
    const std::size_t own = std::size_t(m_components) * std::size_t(m_type->width);
    const std::size_t stride = m_gltf.whole(view, "byteStride").value_or(own);
    const std::size_t room = stride < own || stride > 252 ? 0
                             : bytes->size() < own        ? 0
                                                          : (bytes->size() - own) / stride + 1;
    if (count > room) {
      refuse(tr("expected at most {} items, for which its view has room, got {}", room, count));
      return false;
    }
    for (std::size_t i = 0; i < count; ++i)
      for (int k = 0; k < m_components; ++k)
        values[i * std::size_t(m_components) + std::size_t(k)] =
            component(bytes->data() + i * stride + std::size_t(k * m_type->width), *m_type);
    return true;
  }

  /// Some items stand elsewhere.
  bool replace(GltfItem sparse, std::size_t count, std::vector<double>& values) {
    const GltfItem where = m_gltf.member(sparse, "indices"), what = m_gltf.member(sparse, "values");
    const std::size_t some = m_gltf.whole(sparse, "count").value_or(0);
    if (!where || !what || some > count) {
      m_gltf.fault(sparse, tr("expected indices and values of at most {} items, got others", count));
      return false;
    }
    const GltfItem where_view = m_gltf.named(where, "bufferView", "bufferViews"),
                   what_view = m_gltf.named(what, "bufferView", "bufferViews");
    if (!where_view || !what_view) return false;
    std::vector<double> fresh(some * std::size_t(m_components)), indices(some);
    if (!take(what_view, m_gltf.whole(what, "byteOffset").value_or(0), some, fresh)) return false;
    const GltfType* own_type = m_type;
    const int own_components = m_components;
    m_type = component_type(where);
    m_components = 1;
    const bool good = m_type && m_type->whole && !m_type->is_signed &&
                      take(where_view, m_gltf.whole(where, "byteOffset").value_or(0), some, indices);
    m_type = own_type;
    m_components = own_components;
    if (!good || std::any_of(indices.begin(), indices.end(), [&](double i) { return i >= double(count); })) {
      m_gltf.fault(sparse, tr("expected whole numbers below {} as sparse indices, got others", count));
      return false;
    }
    for (std::size_t i = 0; i < some; ++i)
      for (std::size_t k = 0; k < std::size_t(m_components); ++k)
        values[std::size_t(indices[i]) * std::size_t(m_components) + k] = fresh[i * std::size_t(m_components) + k];
    return true;
  }

  void normalise(std::vector<double>& values) const {
    const GltfItem item = m_gltf.member(m_item, "normalized");
    if (!m_type->whole || !item || !item->truth) return;
    for (double& value : values) value = std::max(value / m_type->full, -1.0);
  }
};

}  // namespace

std::optional<std::vector<Vec3d>> gltf_points(GltfDocument& gltf, GltfItem accessor) {
  GltfAccessor reader(gltf, accessor);
  const std::optional<std::vector<double>> values = reader.read("VEC3", 3);
  if (!values) return std::nullopt;
  std::vector<Vec3d> points(values->size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {(*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2]};
  const auto bad = std::find_if(points.begin(), points.end(), [](Vec3d p) { return !finite(p); });
  if (bad == points.end()) return points;
  gltf.fault(accessor, tr("expected coordinates that are numbers, got {} {} {} as item {}", bad->x, bad->y, bad->z,
                          bad - points.begin()));
  return std::nullopt;
}

std::optional<std::vector<int>> gltf_indices(GltfDocument& gltf, GltfItem accessor, std::size_t vertices) {
  GltfAccessor reader(gltf, accessor);
  const std::optional<std::vector<double>> values = reader.read("SCALAR", 1);
  if (!values) return std::nullopt;
  if (!reader.type().whole || reader.type().is_signed) {
    gltf.fault(accessor, "expected indices of whole numbers without a sign, got others");
    return std::nullopt;
  }
  std::vector<int> indices;
  indices.reserve(values->size());
  for (const double value : *values) {
    if (value >= double(vertices)) {
      gltf.fault(accessor, tr("expected indices below {}, got {} as item {}", vertices, value, indices.size()));
      return std::nullopt;
    }
    indices.push_back(int(value));
  }
  return indices;
}

}  // namespace trocar::geometry
