#include <algorithm>
#include <cmath>
#include <numeric>

#include <trocar/core/tick.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/smoke_drawing.hpp>

namespace trocar::view {
namespace {

// Plumes: our choice, by eye.
constexpr int kPuffs = 26;
constexpr double kPlumeTime = 0.9;    // [s] that a puff is seen
constexpr double kPlumeSpeed = 0.06;  // [m/s] upwards
constexpr double kPlumeGrows = 0.42;  // of its way, in radius
constexpr double kPlumeDense = 0.85;
constexpr double kPlumeFoot = 0.0013, kPlumeThin = 0.005;  // [m] radius at the tip; and at which it is half as dense
constexpr double kSmokes = 0.15;                           // [s] of current until tissue smokes

constexpr float kSmokeClear = 0.01f;  // [g/m^3] everywhere below it: nothing to be seen

// The veil: our choice, by eye.
constexpr float kVeilWide = 0.060f;   // [m] its spread
constexpr float kVeilAside = 0.025f;  // [m] how far its middle lies from that of the smoke
constexpr float kVeilDense = 6.5f;    // of what the same smoke would make in a cloud so wide: a camera's gain shows it
constexpr float kFogHides = 2.0f;     // of the veil, by fog on the lens: all of it where that is half fogged
constexpr int kSpreads = 2;           // how often what is drawn is spread by a cell to each side

const Vec3f kFarColour{0.565f, 0.585f, 0.620f};  // bluish where it is lit from afar

/// How much smoke has not mixed yet with what is around it, and where it is.
struct Unmixed {
  float grams = 0;
  Vec3f middle;  ///< the lower the more it weighs: near where it comes from
};

/// What is denser than its layer of the grid is in the mean: new smoke. It mixes within some seven seconds.
Unmixed unmixed(const render::SmokeVolume& smoke) {
  Unmixed out;
  const int layer = smoke.nx * smoke.ny;
  Vec3f sum{};
  float all = 0, weights = 0;
  for (int k = 0; k < smoke.nz; ++k) {
    const float* row = smoke.density.data() + k * layer;
    const float mean = std::accumulate(row, row + layer, 0.0f) / float(layer);
    for (int i = 0; i < layer; ++i) {
      const float more = std::max(row[i] - mean, 0.0f);
      const float weight = more * float(smoke.nz - k);
      all += more, weights += weight;
      sum += weight * Vec3f{float(i % smoke.nx) + 0.5f, float(i / smoke.nx) + 0.5f, float(k) + 0.5f};
    }
  }
  out.grams = all * smoke.cell * smoke.cell * smoke.cell;
  if (weights > 0) out.middle = smoke.origin + (smoke.cell / weights) * sum;
  return out;
}

/// A bell over the cells along one axis.
std::vector<float> bell(int cells, float first, float cell, float middle) {
  std::vector<float> out;
  for (int i = 0; i < cells; ++i) {
    const float off = (first + (float(i) + 0.5f) * cell - middle) / kVeilWide;
    out.push_back(std::exp(-0.5f * off * off));
  }
  return out;
}

/// Each cell becomes the mean of itself and its neighbours along one axis: a plume is no column of cells.
void spread_along(render::SmokeVolume& smoke, int cells, int stride, std::vector<float>& row) {
  const int all = int(smoke.density.size()), span = cells * stride;
  row.resize(std::size_t(cells));
  for (int first = 0; first < all; ++first) {
    if (first % span >= stride) continue;
    const auto at = [&](int i) -> float& { return smoke.density[std::size_t(first + i * stride)]; };
    for (int i = 0; i < cells; ++i)
      row[std::size_t(i)] = (at(std::max(i - 1, 0)) + at(i) + at(std::min(i + 1, cells - 1))) / 3;
    for (int i = 0; i < cells; ++i) at(i) = row[std::size_t(i)];
  }
}

/// New smoke rolls back from the walls and hangs between lens and tissue, more to one side: the grid's goes straight
/// up. Drawn only, and as much as there is new smoke.
void add_veil(float fog, render::SmokeVolume& smoke) {
  const Unmixed fresh = unmixed(smoke);
  const Vec3f middle = fresh.middle + kVeilAside * any_perpendicular(smoke.up);
  const float most = kVeilDense * std::max(1 - kFogHides * fog, 0.0f) * fresh.grams /
                     (15.75f * kVeilWide * kVeilWide * kVeilWide);  // of a bell: (2 pi)^1.5
  const std::vector<float> x = bell(smoke.nx, smoke.origin.x, smoke.cell, middle.x);
  const std::vector<float> y = bell(smoke.ny, smoke.origin.y, smoke.cell, middle.y);
  const std::vector<float> z = bell(smoke.nz, smoke.origin.z, smoke.cell, middle.z);
  std::size_t i = 0;
  for (const float c : z)
    for (const float b : y)
      for (const float a : x) smoke.density[i++] += most * a * b * c;
}

}  // namespace

void list_smoke(const fluids::SmokeModel& model, const fluids::SmokeState& state, render::Frame& frame) {
  frame.smoke.density.clear();
  const auto densest = std::max_element(state.density.begin(), state.density.end());
  if (densest == state.density.end() || !(*densest > kSmokeClear)) return;
  render::SmokeVolume& smoke = frame.smoke;
  smoke.origin = vec_cast<float>(model.origin);
  smoke.cell = float(model.cell);
  smoke.nx = model.nx, smoke.ny = model.ny, smoke.nz = model.nz;
  smoke.kappa = float(model.kappa);
  smoke.density.reserve(state.density.size());
  for (const float d : state.density) smoke.density.push_back(d > 0 && std::isfinite(d) ? d : 0);
  smoke.rise = 0.5f * float(model.rise_thin);  // curls lag behind what carries them (our choice)
  smoke.colour = kFarColour;
  add_veil(float(state.fog), smoke);
  std::vector<float> row;
  for (int pass = 0; pass < kSpreads; ++pass) {
    spread_along(smoke, smoke.nx, 1, row);
    spread_along(smoke, smoke.ny, smoke.nx, row);
  }
}

void list_plumes(const sim::Model& model, const sim::State& state, render::Frame& frame) {
  const Vec3d up = -1.0 * normalised(model.gravity, {0, 0, -1}), side = any_perpendicular(up), other = cross(up, side);
  for (std::size_t h = 0; h < state.electrodes.size(); ++h) {
    const sim::ElectrodeHand& hand = state.electrodes[h];
    if (!hand.body.exists() || !(hand.current.on_time > kSmokes)) continue;
    const double now = core::kTick * double(state.tick % 1000000) / kPlumeTime * kPuffs, first = std::floor(now);
    for (int k = 0; k < kPuffs; ++k) {
      const double age = (now - first + k) / kPuffs;  // 0 .. 1 of its time
      if (age * kPlumeTime > hand.current.on_time) continue;
      const int own = int(first) - k;
      const double high = kPlumeSpeed * kPlumeTime * std::pow(age, 1.4), stray = 0.16 * high;
      // It bends as it rises, and sways.
      const double bend =
          0.45 * high * high / (kPlumeSpeed * kPlumeTime) + 0.22 * high * std::sin(2.2 * now / kPuffs + 7 * age);
      render::Puff puff;
      puff.centre = vec_cast<float>(hand.at + high * up + (bend + stray * (2 * varied(own, 1) - 1)) * side +
                                    (stray * (2 * varied(own, 2) - 1)) * other);
      const double grown = kPlumeGrows * high * (0.6 + 0.8 * varied(own, 3));
      puff.radius = float(kPlumeFoot + grown);
      // Dense where it leaves the tissue; what widens thins out.
      puff.density = float(kPlumeDense * std::pow(1 - age, 2.2) / (1 + grown / kPlumeThin));
      frame.puffs.push_back(puff);
    }
  }
}

}  // namespace trocar::view
