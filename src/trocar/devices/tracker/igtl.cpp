#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/devices/tracker/igtl.hpp>

namespace trocar::devices {
namespace {

constexpr std::size_t kElement = 70;      // of TDATA: name, kind, a spare byte, matrix
constexpr std::size_t kTurnElement = 50;  // of QTDATA: name, kind, a spare byte, place, quaternion
constexpr std::size_t kElementHead = 22;
constexpr std::uint8_t kTipOnly = 3;     // a kind of element: its rotation means nothing
constexpr std::size_t kStatusHead = 30;  // code, subcode, name of the error
constexpr unsigned kStatusOk = 1;
constexpr double kMillimetre = 1e-3;
constexpr double kFarthestTool = 100;  // [m] no tracker sees further; the protocol's floats could say anything

bool sound(const TrackedPose& pose) {
  for (int i = 0; i < 3; ++i) {
    const Vec3d axis = pose.turned.column(i);
    if (!(std::fabs(length(axis) - 1) < 0.01)) return false;  // no number, or no rotation
    if (!(std::fabs(dot(axis, pose.turned.column((i + 1) % 3))) < 0.01)) return false;
  }
  if (!(dot(cross(pose.turned.column(0), pose.turned.column(1)), pose.turned.column(2)) > 0)) return false;
  return std::fabs(pose.place.x) < kFarthestTool && std::fabs(pose.place.y) < kFarthestTool &&
         std::fabs(pose.place.z) < kFarthestTool;
}

/// Twelve floats: the columns of the rotation, then the place.
TrackedPose pose_of_matrix(IgtlBytes bytes, std::string name) {
  const auto column = [bytes](std::size_t c) {
    return Vec3d{double(float_at(bytes, 12 * c)), double(float_at(bytes, 12 * c + 4)),
                 double(float_at(bytes, 12 * c + 8))};
  };
  return {std::move(name), kMillimetre * column(3), Mat3d::from_columns(column(0), column(1), column(2))};
}

/// Place and quaternion (x, y, z, w), or its first three (w is not negative then), or place alone.
TrackedPose pose_of_position(IgtlBytes bytes, std::string name) {
  TrackedPose pose{std::move(name), kMillimetre * Vec3d{double(float_at(bytes, 0)), double(float_at(bytes, 4)),
                                                        double(float_at(bytes, 8))}};
  if (bytes.size() < 24) return pose;
  const double x = double(float_at(bytes, 12)), y = double(float_at(bytes, 16)), z = double(float_at(bytes, 20));
  const double w =
      bytes.size() < 28 ? std::sqrt(std::max(0.0, 1 - x * x - y * y - z * z)) : double(float_at(bytes, 24));
  if (!(std::fabs(x * x + y * y + z * z + w * w - 1) < 0.02)) {  // no rotation: sound() refuses it
    pose.turned = Mat3d{};
    return pose;
  }
  pose.turned = Mat3d::from_columns({1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                                    {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                                    {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)});
  return pose;
}

/// Exactly where a tracker's own origin is: what a server sends of a tool that it has never seen, or sees no more.
bool is_identity(const TrackedPose& pose) {
  if (pose.place.x != 0 || pose.place.y != 0 || pose.place.z != 0) return false;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      if (pose.turned.m[r][c] != (r == c ? 1 : 0)) return false;
  return true;
}

bool is_read(const std::string& type) {
  constexpr std::array<const char*, 7> kRead = {"TRANSFORM", "POSITION", "QTRANS", "TDATA",
                                                "QTDATA",    "SENSOR",   "STATUS"};
  return std::any_of(kRead.begin(), kRead.end(), [&type](const char* one) { return type == one; });
}

}  // namespace

std::uint64_t igtl_crc(IgtlBytes bytes) noexcept {
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

bool IgtlReader::hear(IgtlBytes bytes, const IgtlListener& listener) {
  m_listener = &listener;
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
      read_body();
      m_in_body = false;
    } else {
      m_sound = read_header();
    }
    m_bytes.clear();
  }
  return m_sound;
}

bool IgtlReader::read_header() {
  const IgtlBytes b(m_bytes);
  m_header = {int(big_endian(b.first(2))), igtl_text(b.subspan(2, 12)), igtl_text(b.subspan(14, kIgtlName)),
              big_endian(b.subspan(42, 8)), big_endian(b.subspan(50, 8))};
  if (m_header.version < 1 || m_header.version > 3) return false;
  if (is_read(m_header.type) && m_header.size <= kMostBody) {
    m_in_body = m_header.size > 0;
    return true;
  }
  m_damaged += is_read(m_header.type);
  m_pass = m_header.size;
  return m_header.size <= kMostPassedOver;
}

/// One tool: where it is, or that it is not seen.
void IgtlReader::give(TrackedPose pose, const IgtlBody& body, const std::string& element) {
  std::string why = why_unseen(body.texts, element);
  if (why.empty() && is_identity(pose) && !is_called_seen(body.texts, element)) why = kSentAsIdentity;
  if (!why.empty()) return m_listener->unseen({std::move(pose.name), std::move(why)});
  if (!sound(pose)) return void(++m_damaged);
  m_listener->pose(pose);
}

void IgtlReader::read_tools(const IgtlBody& body, std::size_t size) {
  for (IgtlBytes left = body.content; !left.empty(); left = left.subspan(size)) {
    const std::string cut = igtl_text(left.first(kIgtlName));
    const IgtlBytes rest = left.subspan(kElementHead, size - kElementHead);
    const std::string name = whole_element_name(body.texts, cut);
    TrackedPose pose = size == kElement ? pose_of_matrix(rest, name) : pose_of_position(rest, name);
    if (left[kIgtlName] == kTipOnly) pose.turned = Mat3d::identity();
    give(std::move(pose), body, cut);
  }
}

bool IgtlReader::read_sensor(IgtlBytes content) {
  if (content.size() < 10 || content.size() != 10u + 8u * content[0] || content[0] > kMostValues) return false;
  SensorValues all{m_header.device, {}};
  for (std::size_t i = 0; i < content[0]; ++i) all.values.push_back(double_at(content, 10 + 8 * i));
  if (!std::all_of(all.values.begin(), all.values.end(), [](double v) { return std::isfinite(v); })) return false;
  m_listener->values(all);
  return true;
}

/// What a device says of itself; all but "OK" means that nothing is seen of it.
bool IgtlReader::read_status(const IgtlBody& body) {
  if (body.content.size() < kStatusHead) return false;
  const unsigned code = unsigned(big_endian(body.content.first(2)));
  if (code == kStatusOk) return true;
  const std::string error = igtl_text(body.content.subspan(10, 20));
  m_listener->unseen({whole_name(body.texts, m_header.device), error.empty() ? fmt::format("STATUS {}", code) : error});
  return true;
}

void IgtlReader::read_body() {
  if (igtl_crc(m_bytes) != m_header.crc) return void(++m_damaged);
  const IgtlBody body = split_body(m_header.version, m_bytes);
  const std::string& type = m_header.type;
  const std::size_t size = body.content.size();
  const auto tools = [&](std::size_t each) { return size % each == 0 && size <= kMostTools * each; };
  if (type == "TRANSFORM" && size == 48) {
    give(pose_of_matrix(body.content, whole_name(body.texts, m_header.device)), body, {});
  } else if ((type == "POSITION" || type == "QTRANS") && (size == 28 || size == 24 || size == 12)) {
    give(pose_of_position(body.content, whole_name(body.texts, m_header.device)), body, {});
  } else if (type == "TDATA" && tools(kElement)) {
    read_tools(body, kElement);
  } else if (type == "QTDATA" && tools(kTurnElement)) {
    read_tools(body, kTurnElement);
  } else if (!(type == "SENSOR" && read_sensor(body.content)) && !(type == "STATUS" && read_status(body))) {
    return void(++m_damaged);
  }
  ++m_messages;
}

}  // namespace trocar::devices
