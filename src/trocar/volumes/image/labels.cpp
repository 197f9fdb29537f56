#include <algorithm>
#include <cmath>

#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/volume.hpp>

namespace trocar::volumes {

const Segment* Labels::find(int label) const {
  const auto found = std::find_if(segments.begin(), segments.end(), [&](const Segment& s) { return s.label == label; });
  return found == segments.end() ? nullptr : &*found;
}

Labels on_grid_of(const Volume& volume) { return {volume.grid, std::vector<std::uint16_t>(volume.grid.count()), {}}; }

std::vector<std::size_t> voxels_per_label(const Labels& labels) {
  std::vector<std::size_t> out(65536);
  for (const std::uint16_t l : labels.at) ++out[l];
  return out;
}

double millilitres(const Labels& labels, int label) {
  return double(std::count(labels.at.begin(), labels.at.end(), std::uint16_t(label))) * labels.grid.voxel_ml();
}

Box box_of(const Labels& labels, int label) {
  Box box{labels.grid.size, {0, 0, 0}};
  std::size_t at = 0;
  for (int k = 0; k < labels.grid.size[2]; ++k)
    for (int j = 0; j < labels.grid.size[1]; ++j)
      for (int i = 0; i < labels.grid.size[0]; ++i, ++at) {
        if (labels.at[at] != label) continue;
        const Index3 v{i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          box.low[a] = std::min(box.low[a], v[a]);
          box.high[a] = std::max(box.high[a], v[a] + 1);
        }
      }
  return box.empty() ? Box{} : box;
}

void name_all(Labels& labels) {
  const std::vector<std::size_t> counts = voxels_per_label(labels);
  for (int label = 1; label < 65536; ++label)
    if (counts[std::size_t(label)] > 0 && !labels.find(label))
      labels.segments.push_back({std::uint16_t(label), "label " + std::to_string(label), colour_of(label), true});
  std::sort(labels.segments.begin(), labels.segments.end(),
            [](const Segment& a, const Segment& b) { return a.label < b.label; });
}

std::array<float, 3> colour_of(int label) {
  // Hues a golden section apart are never near each other for small numbers; two lightnesses help beyond ten.
  const double hue = label * 0.618033988749895 - std::floor(label * 0.618033988749895);
  const double light = label % 2 == 0 ? 0.9 : 0.7;
  std::array<float, 3> out{};
  for (int c = 0; c < 3; ++c) {
    double part = 6 * hue + 4 * c;
    part -= 6 * std::floor(part / 6);
    const double pure = std::clamp(std::fabs(part - 3) - 1, 0.0, 1.0);
    out[std::size_t(c)] = float(light * (0.3 + 0.7 * pure));
  }
  return out;
}

}  // namespace trocar::volumes
