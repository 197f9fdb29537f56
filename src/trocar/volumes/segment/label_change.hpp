// What a tool has changed of a label map: runs of voxels with their old and new label. Undo is the same backwards, and
// costs what was changed and not what is there.
//
//   const LabelChange change = thresholded(volume, labels, {200, 3000}, bone);
//   apply(labels, change);
//   undo(labels, change);
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/volumes/image/labels.hpp>

namespace trocar::volumes {

struct LabelRun {
  std::uint32_t first = 0, count = 0;  ///< voxels, one after the other
  std::uint16_t from = 0, to = 0;
};
struct LabelChange {
  std::vector<LabelRun> runs;  ///< ascending, apart

  bool empty() const { return runs.empty(); }
  std::size_t voxels() const;
  std::size_t bytes() const { return runs.size() * sizeof(LabelRun); }
};

/// The labels must be those that the change was made for: std::invalid_argument where a voxel has another label than
/// the run says, and then nothing is changed.
void apply(Labels& labels, const LabelChange& change);
void undo(Labels& labels, const LabelChange& change);
/// By how much a label's volume grows [mL].
double gained_ml(const LabelChange& change, int label, const Grid& grid);

/// Collects a change voxel by voxel, in ascending order.
class ChangeWriter {
 public:
  explicit ChangeWriter(const Labels& labels);
  void set(std::size_t voxel, std::uint16_t to) {
    const std::uint16_t from = m_labels.at[voxel];
    if (from == to) return;
    if (!m_change.runs.empty()) {
      LabelRun& last = m_change.runs.back();
      if (last.first + last.count == voxel && last.from == from && last.to == to) return void(++last.count);
    }
    m_change.runs.push_back({std::uint32_t(voxel), 1, from, to});
  }
  LabelChange taken() { return std::move(m_change); }

 private:
  const Labels& m_labels;
  LabelChange m_change;
};

}  // namespace trocar::volumes
