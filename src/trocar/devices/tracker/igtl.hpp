// What a tracker says over OpenIGTLink: poses of tools, and numbers of sensors (grips). Bytes in, messages out; no
// socket, so that tests and fuzzing hand it theirs.
//
// A message is a header of 58 bytes (version, type, device, time stamp, size, CRC-64, all big-endian) and a body.
// TRANSFORM, POSITION (QTRANS), TDATA, QTDATA, SENSOR and STATUS are read, of version 1 and, with extended headers, of
// 2 and 3; other types are passed over without being stored. A stream cannot be found again once a header is unsound:
// then it has ended, and who listens connects again.
//
// A tool may not be seen: its server says so in a text (igtl_texts.hpp), by a STATUS of the tool's name, or sends the
// exact identity, at which no tool is ever measured.
//
//   IgtlReader reader;
//   const IgtlListener listener{[&](const TrackedPose& pose) {...}, [&](const UnseenTool& tool) {...},
//                               [&](const SensorValues& values) {...}};
//   const bool sound = reader.hear(bytes, listener);
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <trocar/devices/tracker/igtl_texts.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::devices {

/// Where something is in the tracker's frame.
struct TrackedPose {
  std::string name;
  Vec3d place;                       ///< [m]; the protocol has millimetres
  Mat3d turned = Mat3d::identity();  ///< columns: where its axes point
};

/// A tool of which the server says that it does not see it.
struct UnseenTool {
  std::string name;
  std::string why;  ///< the server's word, as MISSING, or kSentAsIdentity
};
inline constexpr char kSentAsIdentity[] = "sent as the identity";

struct SensorValues {
  std::string name;
  std::vector<double> values;  ///< finite
};

/// Who hears what is sent.
struct IgtlListener {
  std::function<void(const TrackedPose&)> pose;
  std::function<void(const UnseenTool&)> unseen;
  std::function<void(const SensorValues&)> values;
};

/// CRC-64 of ECMA-182, as the protocol has it.
std::uint64_t igtl_crc(std::span<const std::uint8_t> bytes) noexcept;

class IgtlReader {
 public:
  static constexpr std::size_t kHeader = 58;
  static constexpr std::size_t kMostBody = 65536;             ///< of what is read
  static constexpr std::uint64_t kMostPassedOver = 1u << 28;  ///< bytes of a message of another kind, an image
  static constexpr std::size_t kMostTools = 64, kMostValues = 64;

  /// Everything that has come to its end goes to the listener. False: the stream is unsound and stays so.
  bool hear(std::span<const std::uint8_t> bytes, const IgtlListener& listener);

  std::uint64_t messages() const noexcept { return m_messages; }  ///< that were sound
  std::uint64_t damaged() const noexcept { return m_damaged; }    ///< whose body is not what its checksum says, or odd
  std::size_t kept() const noexcept { return m_bytes.size(); }    ///< bytes that wait for the rest of a message

 private:
  struct Header {
    int version = 0;
    std::string type, device;
    std::uint64_t size = 0, crc = 0;
  };
  bool read_header();
  void read_body();
  void read_tools(const IgtlBody& body, std::size_t size);
  bool read_sensor(IgtlBytes content);
  bool read_status(const IgtlBody& body);
  void give(TrackedPose pose, const IgtlBody& body, const std::string& element);

  const IgtlListener* m_listener = nullptr;  ///< in hear()
  std::vector<std::uint8_t> m_bytes;
  Header m_header;
  bool m_in_body = false, m_sound = true;
  std::uint64_t m_pass = 0;  ///< bytes to come that are of no interest
  std::uint64_t m_messages = 0, m_damaged = 0;
};

// For tests and simulated trackers.

/// A whole message. @param texts  of version 2 and 3
std::vector<std::uint8_t> igtl_message(const std::string& type, const std::string& device,
                                       const std::vector<std::uint8_t>& content, int version = 1,
                                       const IgtlTexts& texts = {});
std::vector<std::uint8_t> igtl_transform(const TrackedPose& pose, int version = 1, const IgtlTexts& texts = {});
/// Of version 1.
std::vector<std::uint8_t> igtl_sensor(const SensorValues& values);

}  // namespace trocar::devices
