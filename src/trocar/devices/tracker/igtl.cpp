#include <algorithm>
#include <cmath>
#include <cstring>

#include <trocar/devices/tracker/igtl.hpp>

namespace trocar::devices {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kElement = 70;  // of TDATA: name, kind, a spare byte, matrix
constexpr double kMillimetre = 1e-3;
constexpr double kFarthest = 100;  // [m] no tracker sees further; the protocol's floats could say anything

std::uint64_t big_endian(Bytes bytes) noexcept {
  std::uint64_t value = 0;
  for (const std::uint8_t b : bytes) value = value << 8 | b;
  return value;
}

float float_at(Bytes bytes, std::size_t at) noexcept {
  const std::uint32_t bits = std::uint32_t(big_endian(bytes.subspan(at, 4)));
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double double_at(Bytes bytes, std::size_t at) noexcept {
  const std::uint64_t bits = big_endian(bytes.subspan(at, 8));
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Up to the first zero; what cannot be printed becomes '?'.
std::string text_of(Bytes bytes) {
  std::string text;
  for (const std::uint8_t b : bytes) {
    if (b == 0) break;
    text += b >= 32 && b < 127 ? char(b) : '?';
  }
  return text;
}

bool sound(const TrackedPose& pose) {
  for (int i = 0; i < 3; ++i) {
    const Vec3d axis = pose.turned.column(i);
    if (!(std::fabs(length(axis) - 1) < 0.01)) return false;  // no number, or no rotation
    if (!(std::fabs(dot(axis, pose.turned.column((i + 1) % 3))) < 0.01)) return false;
  }
  if (!(dot(cross(pose.turned.column(0), pose.turned.column(1)), pose.turned.column(2)) > 0)) return false;
  return std::fabs(pose.place.x) < kFarthest && std::fabs(pose.place.y) < kFarthest &&
         std::fabs(pose.place.z) < kFarthest;
}

/// Twelve floats: the columns of the rotation, then the place.
TrackedPose pose_of_matrix(Bytes bytes, std::string name) {
  const auto column = [bytes](std::size_t c) {
    return Vec3d{double(float_at(bytes, 12 * c)), double(float_at(bytes, 12 * c + 4)),
                 double(float_at(bytes, 12 * c + 8))};
  };
  return {std::move(name), kMillimetre * column(3), Mat3d::from_columns(column(0), column(1), column(2))};
}

/// Place and quaternion (x, y, z, w), or place alone.
TrackedPose pose_of_position(Bytes bytes, std::string name) {
  TrackedPose pose{std::move(name), kMillimetre * Vec3d{double(float_at(bytes, 0)), double(float_at(bytes, 4)),
                                                        double(float_at(bytes, 8))}};
  if (bytes.size() < 28) return pose;
  const double x = double(float_at(bytes, 12)), y = double(float_at(bytes, 16)), z = double(float_at(bytes, 20)),
               w = double(float_at(bytes, 24));
  pose.turned = Mat3d::from_columns({1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                                    {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                                    {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)});
  return pose;
}

bool is_read(const std::string& type) {
  return type == "TRANSFORM" || type == "POSITION" || type == "QTRANS" || type == "TDATA" || type == "SENSOR";
}

void put(std::vector<std::uint8_t>& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(std::uint8_t(value >> (8 * i)));
}
void put_text(std::vector<std::uint8_t>& out, const std::string& text, std::size_t room) {
  for (std::size_t i = 0; i < room; ++i) out.push_back(i < text.size() ? std::uint8_t(text[i]) : 0);
}
void put_float(std::vector<std::uint8_t>& out, double value) {
  const float narrow = float(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &narrow, sizeof bits);
  put(out, bits, 4);
}

std::vector<std::uint8_t> message(const std::string& type, const std::string& device,
                                  const std::vector<std::uint8_t>& body) {
  std::vector<std::uint8_t> out;
  put(out, 1, 2);
  put_text(out, type, 12);
  put_text(out, device, 20);
  put(out, 0, 8);
  put(out, body.size(), 8);
  put(out, igtl_crc(body), 8);
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

}  // namespace

std::uint64_t igtl_crc(Bytes bytes) noexcept {
  static const std::array<std::uint64_t, 256> table = [] {
    std::array<std::uint64_t, 256> t{};
    for (std::uint64_t i = 0; i < 256; ++i) {
      std::uint64_t crc = i << 56;
      for (int bit = 0; bit < 8; ++bit) crc = (crc >> 63) != 0 ? crc << 1 ^ 0x42f0e1eba9ea3693ull : crc << 1;
      t[i] = crc;
    }
    return t;
  }();
  std::uint64_t crc = 0;
  for (const std::uint8_t b : bytes) crc = table[(crc >> 56) ^ b] ^ crc << 8;
  return crc;
}

bool IgtlReader::hear(Bytes bytes, const OnPose& pose, const OnValues& values) {
  while (m_sound && !bytes.empty()) {
    if (m_pass > 0) {
      const std::size_t some = std::size_t(std::min<std::uint64_t>(m_pass, bytes.size()));
      m_pass -= some;
      bytes = bytes.subspan(some);
      continue;
    }
    const std::size_t whole = m_in_body ? std::size_t(m_header.size) : kHeader;
    const std::size_t some = std::min(whole - m_bytes.size(), bytes.size());
    m_bytes.insert(m_bytes.end(), bytes.begin(), bytes.begin() + std::ptrdiff_t(some));
    bytes = bytes.subspan(some);
    if (m_bytes.size() < whole) break;
    if (m_in_body) {
      read_body(pose, values);
      m_in_body = false;
    } else {
      m_sound = read_header();
    }
    m_bytes.clear();
  }
  return m_sound;
}

bool IgtlReader::read_header() {
  const Bytes b(m_bytes);
  m_header = {int(big_endian(b.first(2))), text_of(b.subspan(2, 12)), text_of(b.subspan(14, 20)),
              big_endian(b.subspan(42, 8)), big_endian(b.subspan(50, 8))};
  if (m_header.version < 1 || m_header.version > 3) return false;
  if (is_read(m_header.type)) {
    if (m_header.size > kMostBody) return false;
    m_in_body = m_header.size > 0;
    return true;
  }
  m_pass = m_header.size;
  return m_header.size <= kMostPassedOver;
}

void IgtlReader::read_body(const OnPose& pose, const OnValues& values) {
  Bytes body(m_bytes);
  const auto give = [&](const TrackedPose& one) { sound(one) ? pose(one) : void(++m_damaged); };
  if (igtl_crc(body) != m_header.crc) return void(++m_damaged);
  if (m_header.version > 1) {
    // An extended header before the content, a table of texts after it.
    if (body.size() < 12) return void(++m_damaged);
    const std::uint64_t extended = big_endian(body.first(2));
    const std::uint64_t after = big_endian(body.subspan(2, 2)) + big_endian(body.subspan(4, 4));
    if (extended < 12 || extended + after > body.size()) return void(++m_damaged);
    body = body.subspan(std::size_t(extended), std::size_t(body.size() - extended - after));
  }
  const std::string& type = m_header.type;
  if (type == "TRANSFORM" && body.size() == 48) {
    give(pose_of_matrix(body, m_header.device));
  } else if ((type == "POSITION" || type == "QTRANS") && (body.size() == 28 || body.size() == 12)) {
    give(pose_of_position(body, m_header.device));
  } else if (type == "TDATA" && body.size() % kElement == 0 && body.size() <= kMostTools * kElement) {
    for (; !body.empty(); body = body.subspan(kElement))
      give(pose_of_matrix(body.subspan(22, 48), text_of(body.first(20))));
  } else if (type == "SENSOR" && body.size() >= 10 && body.size() == 10u + 8u * body[0] && body[0] <= kMostValues) {
    SensorValues all{m_header.device, {}};
    for (std::size_t i = 0; i < body[0]; ++i) all.values.push_back(double_at(body, 10 + 8 * i));
    const bool finite = std::all_of(all.values.begin(), all.values.end(), [](double v) { return std::isfinite(v); });
    finite ? values(all) : void(++m_damaged);
  } else {
    return void(++m_damaged);
  }
  ++m_messages;
}

std::vector<std::uint8_t> igtl_transform(const TrackedPose& pose) {
  std::vector<std::uint8_t> body;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) put_float(body, pose.turned.m[r][c]);
  for (const double mm : {pose.place.x, pose.place.y, pose.place.z}) put_float(body, mm / kMillimetre);
  return message("TRANSFORM", pose.name, body);
}

std::vector<std::uint8_t> igtl_sensor(const SensorValues& values) {
  std::vector<std::uint8_t> body{std::uint8_t(std::min(values.values.size(), IgtlReader::kMostValues)), 0};
  put(body, 0, 8);
  for (std::size_t i = 0; i < body[0]; ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &values.values[i], sizeof bits);
    put(body, bits, 8);
  }
  return message("SENSOR", values.name, body);
}

}  // namespace trocar::devices
