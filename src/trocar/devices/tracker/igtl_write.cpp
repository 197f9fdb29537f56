#include <algorithm>
#include <cstring>

#include <trocar/devices/tracker/igtl.hpp>

namespace trocar::devices {
namespace {

constexpr std::uint64_t kAscii = 3;    // how a text is written
constexpr double kMillimetres = 1000;  // of a metre

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

/// An extended header, the content, and a table of texts.
std::vector<std::uint8_t> with_texts(const std::vector<std::uint8_t>& content, const IgtlTexts& texts) {
  std::vector<std::uint8_t> table, all, body;
  put(table, texts.size(), 2);
  for (const auto& [key, value] : texts) {
    put(table, key.size(), 2);
    put(table, kAscii, 2);
    put(table, value.size(), 4);
    put_text(all, key, key.size());
    put_text(all, value, value.size());
  }
  put(body, 12, 2);
  put(body, table.size(), 2);
  put(body, all.size(), 4);
  put(body, 0, 4);
  const auto add = [&body](const std::vector<std::uint8_t>& part) {
    body.insert(body.end(), part.begin(), part.end());
  };
  add(content), add(table), add(all);
  return body;
}

}  // namespace

std::vector<std::uint8_t> igtl_message(const std::string& type, const std::string& device,
                                       const std::vector<std::uint8_t>& content, int version, const IgtlTexts& texts) {
  const std::vector<std::uint8_t> body = version > 1 ? with_texts(content, texts) : content;
  std::vector<std::uint8_t> out;
  put(out, std::uint64_t(version), 2);
  put_text(out, type, 12);
  put_text(out, device, kIgtlName);
  put(out, 0, 8);
  put(out, body.size(), 8);
  put(out, igtl_crc(body), 8);
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

std::vector<std::uint8_t> igtl_transform(const TrackedPose& pose, int version, const IgtlTexts& texts) {
  std::vector<std::uint8_t> body;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) put_float(body, pose.turned.m[r][c]);
  for (const double metres : {pose.place.x, pose.place.y, pose.place.z}) put_float(body, kMillimetres * metres);
  return igtl_message("TRANSFORM", pose.name, body, version, texts);
}

std::vector<std::uint8_t> igtl_sensor(const SensorValues& values) {
  std::vector<std::uint8_t> body{std::uint8_t(std::min(values.values.size(), IgtlReader::kMostValues)), 0};
  put(body, 0, 8);
  for (std::size_t i = 0; i < body[0]; ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &values.values[i], sizeof bits);
    put(body, bits, 8);
  }
  return igtl_message("SENSOR", values.name, body);
}

}  // namespace trocar::devices
