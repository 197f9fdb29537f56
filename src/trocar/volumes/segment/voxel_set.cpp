#include <algorithm>

#include <trocar/core/require.hpp>
#include <trocar/volumes/segment/voxel_set.hpp>

namespace trocar::volumes {
namespace {

/// Rules with values as numbers that voxels store.
class Allowed {
 public:
  Allowed(const Volume& volume, const Labels& labels, const EditRules& rules, std::uint16_t label)
      : m_volume(volume), m_labels(labels), m_rules(rules), m_label(label) {
    require_same_size(volume, labels);
  }
  /// May the voxel get the tool's label, or lose it?
  bool operator()(std::size_t voxel) const {
    const std::uint16_t now = m_labels.at[voxel];
    if (m_rules.inside && now != *m_rules.inside && now != m_label) return false;
    if (!m_rules.overwrite && now != 0 && now != m_label) return false;
    if (!m_rules.values) return true;
    const double value = m_volume.value_of(m_volume.stored[voxel]);
    return value >= (*m_rules.values)[0] && value <= (*m_rules.values)[1];
  }

 private:
  const Volume& m_volume;
  const Labels& m_labels;
  const EditRules& m_rules;
  std::uint16_t m_label;
};

}  // namespace

std::size_t VoxelSet::count() const { return std::size_t(std::count(in.begin(), in.end(), std::uint8_t(1))); }

VoxelSet voxels_of(const Labels& labels, int label, const Box& box) {
  VoxelSet out(common(box, whole(labels.grid)));
  out.each(labels.grid, [&](std::size_t n, std::size_t at) { out.in[n] = labels.at[at] == label ? 1 : 0; });
  return out;
}
VoxelSet voxels_of(const Labels& labels, int label, const Index3& margin) {
  const Box box = box_of(labels, label);
  return box.empty() ? VoxelSet(Box{}) : voxels_of(labels, label, widened(box, margin, labels.grid));
}

LabelChange labelled(const Volume& volume, const Labels& labels, const VoxelSet& set, std::uint16_t label,
                     const EditRules& rules) {
  const Allowed allowed(volume, labels, rules, label);
  ChangeWriter out(labels);
  set.each(labels.grid, [&](std::size_t n, std::size_t at) {
    if (set.in[n] != 0 && allowed(at)) out.set(at, label);
  });
  return out.taken();
}

LabelChange replaced(const Volume& volume, const Labels& labels, std::uint16_t label, const VoxelSet& set,
                     const EditRules& rules) {
  const Allowed allowed(volume, labels, rules, label);
  // Outside of both boxes neither the label nor the set is.
  Box box = box_of(labels, label);
  if (box.empty()) box = set.box;
  if (!set.box.empty())
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], set.box.low[k]);
      box.high[k] = std::max(box.high[k], set.box.high[k]);
    }
  ChangeWriter out(labels);
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j)
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        const std::size_t at = labels.grid.index(i, j, k);
        const bool is = labels.at[at] == label, becomes = set.has({i, j, k});
        if (is != becomes && allowed(at)) out.set(at, becomes ? label : 0);
      }
  return out.taken();
}

void require_same_size(const Volume& volume, const Labels& labels) {
  core::require(volume.grid.size == labels.grid.size && volume.stored.size() == labels.at.size(),
                "labels and volume must have the same number of voxels");
}

}  // namespace trocar::volumes
