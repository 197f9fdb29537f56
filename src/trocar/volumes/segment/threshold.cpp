#include <algorithm>
#include <cmath>

#include <trocar/volumes/segment/threshold.hpp>

namespace trocar::volumes {
namespace {

bool between(double value, const std::array<double, 2>& range) { return value >= range[0] && value <= range[1]; }

}  // namespace

LabelChange thresholded(const Volume& volume, const Labels& labels, std::array<double, 2> values, std::uint16_t label,
                        const EditRules& rules) {
  require_same_size(volume, labels);
  VoxelSet set(whole(labels.grid));
  for (std::size_t i = 0; i < set.in.size(); ++i)
    set.in[i] = between(volume.value_of(volume.stored[i]), values) ? 1 : 0;
  return labelled(volume, labels, set, label, rules);
}

LabelChange grown(const Volume& volume, const Labels& labels, std::span<const Index3> seeds,
                  std::array<double, 2> values, std::uint16_t label, const EditRules& rules) {
  require_same_size(volume, labels);
  VoxelSet set(whole(labels.grid));
  std::vector<std::size_t> open;
  const auto take = [&](const Index3& v) {
    if (!labels.grid.has(v)) return;
    const std::size_t at = labels.grid.index(v);
    if (set.in[at] != 0 || !between(volume.value_of(volume.stored[at]), values)) return;
    set.in[at] = 1;
    open.push_back(at);
  };
  for (const Index3& seed : seeds) take(seed);
  while (!open.empty()) {
    const Index3 v = labels.grid.place(open.back());
    open.pop_back();
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Index3 next = v;
        next[axis] += step;
        take(next);
      }
  }
  return labelled(volume, labels, set, label, rules);
}

namespace {

/// Voxels in the order of their cost, which grows by 1 .. kMostStep in a step: a ring of buckets.
class BucketQueue {
 public:
  static constexpr std::uint32_t kMostStep = 255;

  void push(std::uint32_t cost, std::uint32_t voxel) {
    m_ring[cost % kBuckets].push_back(voxel);
    ++m_count;
  }
  bool empty() const { return m_count == 0; }
  /// The cheapest; `cost` rises.
  std::uint32_t pop(std::uint32_t& cost) {
    while (m_ring[cost % kBuckets].empty()) ++cost;
    auto& bucket = m_ring[cost % kBuckets];
    const std::uint32_t voxel = bucket.back();
    bucket.pop_back();
    --m_count;
    return voxel;
  }

 private:
  static constexpr std::uint32_t kBuckets = kMostStep + 1;
  std::array<std::vector<std::uint32_t>, kBuckets> m_ring;
  std::size_t m_count = 0;
};

/// Around all labels, as far as they may grow.
Box box_of_all(const Labels& labels, double margin_mm) {
  Box box{labels.grid.size, {0, 0, 0}};
  for (std::size_t at = 0; at < labels.at.size(); ++at) {
    if (labels.at[at] == 0) continue;
    const Index3 v = labels.grid.place(at);
    for (std::size_t k = 0; k < 3; ++k)
      box.low[k] = std::min(box.low[k], v[k]), box.high[k] = std::max(box.high[k], v[k] + 1);
  }
  if (box.empty()) return {};
  Index3 margin{};
  for (int k = 0; k < 3; ++k)
    margin[std::size_t(k)] = int(std::clamp(std::ceil(margin_mm / labels.grid.spacing[k]), 0.0, 1e6));
  return widened(box, margin, labels.grid);
}

class Competition {
 public:
  Competition(const Volume& volume, const Labels& labels, const CompeteOptions& options)
      : m_volume(volume), m_labels(labels), m_box(box_of_all(labels, options.margin_mm)), m_options(options) {}

  /// The winner of each voxel of the box.
  std::vector<std::uint16_t> run() {
    start();
    std::uint32_t cost = 0;
    std::size_t done = 0;
    while (!m_queue.empty()) {
      const std::uint32_t voxel = m_queue.pop(cost);
      if (m_cost[voxel] != cost) continue;  // was reached more cheaply meanwhile
      if (++done % 1'000'000 == 0) tell(m_options.progress, double(done) / double(m_cost.size()));
      spread(voxel, cost);
    }
    return std::move(m_owner);
  }
  const VoxelSet& box() const { return m_box; }

 private:
  const Volume& m_volume;
  const Labels& m_labels;
  VoxelSet m_box;
  const CompeteOptions& m_options;
  std::vector<std::uint32_t> m_cost;
  std::vector<std::uint16_t> m_owner;
  std::vector<std::int16_t> m_value;
  std::array<double, 3> m_length{};
  BucketQueue m_queue;

  void start() {
    m_cost.assign(m_box.in.size(), ~std::uint32_t(0));
    m_owner.assign(m_box.in.size(), 0);
    m_value.resize(m_box.in.size());
    const double least = m_labels.grid.least_spacing();
    for (int k = 0; k < 3; ++k) m_length[std::size_t(k)] = m_labels.grid.spacing[k] / least;
    m_box.each(m_labels.grid, [&](std::size_t n, std::size_t at) {
      m_value[n] = m_volume.stored[at];
      if (m_labels.at[at] == 0) return;
      m_owner[n] = m_labels.at[at];
      m_cost[n] = 0;
      m_queue.push(0, std::uint32_t(n));
    });
  }

  std::uint32_t step_cost(std::size_t a, std::size_t b, std::size_t axis) const {
    const double difference = m_volume.scale * std::abs(int(m_value[a]) - int(m_value[b]));
    const double cost = 4 * m_length[axis] * (1 + difference / m_options.contrast);
    return std::uint32_t(std::clamp(cost, 1.0, double(BucketQueue::kMostStep)));
  }

  void spread(std::uint32_t voxel, std::uint32_t cost) {
    const Index3 size = m_box.size();
    const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]);
    const std::size_t stride[] = {1, nx, nx * ny};
    const std::size_t place[] = {voxel % nx, voxel / nx % ny, voxel / nx / ny};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        if (side < 0 ? place[axis] == 0 : place[axis] + 1 == std::size_t(size[axis])) continue;
        const std::size_t next = side < 0 ? voxel - stride[axis] : voxel + stride[axis];
        const std::uint32_t reached = cost + step_cost(voxel, next, axis);
        if (reached >= m_cost[next]) continue;
        m_cost[next] = reached;
        m_owner[next] = m_owner[voxel];
        m_queue.push(reached, std::uint32_t(next));
      }
  }
};

}  // namespace

LabelChange grown_from_labels(const Volume& volume, const Labels& labels, const CompeteOptions& options,
                              const EditRules& rules) {
  require_same_size(volume, labels);
  Competition competition(volume, labels, options);
  const std::vector<std::uint16_t> owner = competition.run();
  ChangeWriter out(labels);
  competition.box().each(labels.grid, [&](std::size_t n, std::size_t at) {
    if (labels.at[at] != 0) return;
    if (rules.inside && *rules.inside != 0) return;
    if (rules.values && !between(volume.value_of(volume.stored[at]), *rules.values)) return;
    out.set(at, owner[n]);
  });
  return out.taken();
}

}  // namespace trocar::volumes
