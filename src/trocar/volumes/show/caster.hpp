// A volume as a block, by casting rays on the processor: no graphics card is asked for. [features 66, 67]
//
//   VolumeCaster caster(volume, pool);
//   caster.set_transfer(transfer_preset(TransferPreset::bone));
//   const Rendered moving = caster.render(view, moving_quality());      // while the mouse moves
//   const Rendered still = caster.render(view, {});                     // when it rests
//   QualityGovernor governor(50);                                       // or: as good as 50 ms allow
//   Rendered r = caster.render(view, governor.quality());  governor.took(r.milliseconds);
//
// Rays go front to back through trilinear samples. Cells in which nothing can be seen are skipped, and a ray ends where
// nothing behind would be seen. The picture differs in its last bits between instruction sets.
#pragma once

#include <atomic>
#include <memory>
#include <span>

#include <trocar/core/parallel.hpp>
#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/volume.hpp>
#include <trocar/volumes/show/transfer.hpp>
#include <trocar/volumes/show/view.hpp>

namespace trocar::volumes {

struct Quality {
  int shrink = 1;             ///< a pixel of the picture stands for so many along each side of the view
  double step = 0.5;          ///< between samples [smallest distance of voxels]
  bool fine_gradient = true;  ///< shading by slopes over two voxels; else within the cell: coarser, and cheaper
  /// Looked at between tiles: where it becomes true, the rest of the picture is left empty.
  const std::atomic<bool>* stop = nullptr;
};
/// Half of the view's width and height, every fourth sample.
Quality moving_quality();

/// Shown is where dot(normal, p) >= offset, p in the frame of scenes [m].
struct ClipPlane {
  Vec3d normal;
  double offset = 0;
};

struct Rendered {
  Picture picture;  ///< of the view's size divided by quality.shrink, rounded up
  double milliseconds = 0;
  bool finished = true;  ///< false: it was stopped
};

class VolumeCaster {
 public:
  /// The volume and the pool must outlive the caster. At least 2 voxels along each axis, and a grid that is not
  /// sheared: else std::invalid_argument.
  VolumeCaster(const Volume& volume, core::ThreadPool& pool);
  ~VolumeCaster();
  VolumeCaster(const VolumeCaster&) = delete;
  VolumeCaster& operator=(const VolumeCaster&) = delete;

  void set_transfer(const TransferFunction& transfer);
  /// At most 7 planes; more are std::invalid_argument.
  void set_planes(std::span<const ClipPlane> planes);
  /// Only voxels of the box [of the volume's grid] are shown; empty: all.
  void set_box(const Box& box);
  /// Labels tint what they lie on in their segment's colour; what is not `visible` among the segments is not shown.
  /// Call it again after labels changed. The first 255 segments count. Null: none.
  void set_labels(const Labels* labels, double tint = 0.6);

  Rendered render(const View& view, const Quality& quality);

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// Keeps pictures within a time: coarser after one that took too long, finer after some that would have been quick
/// enough.
class QualityGovernor {
 public:
  explicit QualityGovernor(double budget_ms) : m_budget(budget_ms) {}
  Quality quality() const;
  void took(double milliseconds);

 private:
  double m_budget;
  int m_level = 5, m_quick = 0;
};

}  // namespace trocar::volumes
