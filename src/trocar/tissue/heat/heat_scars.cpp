#include <algorithm>
#include <array>
#include <cstring>

#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/heat/heat_bricks.hpp>
#include <trocar/tissue/heat/heat_scars.hpp>

namespace trocar::tissue {
namespace {

constexpr std::array<float, 6> kCoagulated{0, 0.2f, 0.4f, 0.6f, 0.8f, 1};
constexpr std::array<float, 3> kWater{1, 0.5f, 0};
constexpr std::array<float, 8> kPeak{0, 23, 43, 53, 63, 113, 138, 163};  // [K] over 37 C
constexpr std::size_t kShades = kCoagulated.size() * kWater.size() * kPeak.size();
constexpr std::uint8_t kNoTissue = 0, kAsItWas = 1;  // the first shade, too

template <std::size_t n>
std::size_t nearest(const std::array<float, n>& levels, float value) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < n; ++i)
    if (std::abs(levels[i] - value) < std::abs(levels[best] - value)) best = i;
  return best;
}

std::uint8_t shade_of(const HeatState& s, std::size_t cell) {
  if (!(s.cells[cell] & HeatState::kTissue)) return kNoTissue;
  const float coagulated = 1 - float(portable::exp(-double(s.damage[cell])));
  const std::size_t shade =
      (nearest(kCoagulated, coagulated) * kWater.size() + nearest(kWater, s.water[cell])) * kPeak.size() +
      nearest(kPeak, s.peak[cell]);
  return std::uint8_t(kAsItWas + shade);
}

bool set_shade(std::uint8_t byte, std::size_t cell, HeatState& s) {
  if (byte == kNoTissue) return true;
  const std::size_t shade = byte - kAsItWas;
  if (shade >= kShades) return false;
  const float coagulated = kCoagulated[shade / (kWater.size() * kPeak.size())];
  s.cells[cell] = HeatState::kTissue;
  s.damage[cell] = coagulated < 1 ? float(-portable::log(1 - double(coagulated))) : 10.0f;
  s.water[cell] = kWater[shade / kPeak.size() % kWater.size()];
  s.peak[cell] = kPeak[shade % kPeak.size()];
  return true;
}

template <class T>
void put(std::vector<std::uint8_t>& out, const T& value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

/// Value and length of run less one, until all cells are covered.
void put_brick(const HeatState& s, std::size_t brick, std::vector<std::uint8_t>& out) {
  const std::size_t first = brick * kBrickCells;
  for (std::size_t c = 0; c < kBrickCells;) {
    const std::uint8_t shade = shade_of(s, first + c);
    std::size_t run = 1;
    while (run < 256 && c + run < kBrickCells && shade_of(s, first + c + run) == shade) ++run;
    out.push_back(shade);
    out.push_back(std::uint8_t(run - 1));
    c += run;
  }
}

bool has_scar(const HeatState& s, std::size_t brick) {
  for (std::size_t c = 0; c < kBrickCells; ++c)
    if (shade_of(s, brick * kBrickCells + c) > kAsItWas) return true;
  return false;
}

bool is_near(const BrickKey& key) {
  constexpr std::int32_t kFar = 1 << 20;
  return key.body.exists() && std::max({std::abs(key.i), std::abs(key.j), std::abs(key.k)}) < kFar;
}

/// The same way back; false where the bytes are no scars.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : m_bytes(bytes) {}
  std::size_t at = 0;

  template <class T>
  bool take(T& value) {
    if (m_bytes.size() - at < sizeof value) return false;
    std::memcpy(&value, m_bytes.data() + at, sizeof value);
    at += sizeof value;
    return true;
  }
  bool take_brick(std::size_t brick, HeatState& s) {
    for (std::size_t c = 0; c < kBrickCells;) {
      std::uint8_t shade = 0, more = 0;
      if (!take(shade) || !take(more) || c + more + 1 > kBrickCells) return false;
      for (std::size_t end = c + more + 1; c < end; ++c)
        if (!set_shade(shade, brick * kBrickCells + c, s)) return false;
    }
    return true;
  }

 private:
  std::span<const std::uint8_t> m_bytes;
};

}  // namespace

void put_scars(const HeatState& s, std::vector<std::uint8_t>& out) {
  const std::size_t count_at = out.size();
  std::uint32_t count = 0;
  put(out, count);
  for (std::size_t b = 0; b < s.slot.size(); ++b) {
    if (s.slot[b] == HeatState::kUnused || !has_scar(s, b)) continue;
    ++count;
    put(out, s.key[b]);
    put_brick(s, b, out);
  }
  std::memcpy(out.data() + count_at, &count, sizeof count);
}

std::ptrdiff_t take_scars(const HeatModel& m, std::span<const std::uint8_t> bytes, HeatState& s) {
  s = cold(m);
  std::fill(s.water.begin(), s.water.end(), 1.0f);
  Reader in(bytes);
  std::uint32_t count = 0;
  if (!in.take(count) || count > std::uint32_t(m.bricks)) return -1;
  for (std::uint32_t b = 0; b < count; ++b) {
    if (!in.take(s.key[b]) || !is_near(s.key[b]) || !in.take_brick(b, s)) return -1;
    if (heat::find(m, s, s.key[b]) != heat::kNobody) return -1;  // twice
    s.slot[b] = HeatState::kAsleep;
    heat::index_bricks(m, s);
  }
  return std::ptrdiff_t(in.at);
}

}  // namespace trocar::tissue
