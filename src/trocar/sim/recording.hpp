// A recording: everything that a replay needs, in one append-only file that is readable after a crash up to the last
// second. Header (scene path, model hash, build and format versions, exercise, seed, JSON metadata), then blocks, each
// with kind, size, tick range and checksum: the input log (one entry per tick, run-length coded by changed fields),
// state hashes every 100 ticks, display keyframes at 10 Hz, and an end mark with the result.
//
//   RecordingWriter writer(path, header);            // throws core::EnvironmentLacks when the disk says no
//   writer.tick(tick, input);                        // every tick; flushes a block at least once a second
//   writer.hash(tick, state_hash);  writer.keyframe(tick, bytes);
//   writer.finish(result_json);
//
//   const Recording r = read_recording(path);        // throws core::BadInput (damaged header); a torn tail is cut off
//
// Numbers are little-endian. A block that fails its checksum ends the readable part: `complete` is then false.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <trocar/sim/input.hpp>

namespace trocar::sim {

inline constexpr int kHashEvery = 100;      ///< ticks between state hashes
inline constexpr int kKeyframeEvery = 100;  ///< ticks between display keyframes (10 Hz)

struct RecordingHeader {
  std::uint32_t format = 1;
  std::uint64_t model_hash = 0;   ///< of the Model it was made with: another physics refuses to verify
  std::uint64_t seed = 0;
  std::string exercise;           ///< name under scenes/ or path
  std::string program_version;
  std::string metadata_json;      ///< trainee, input device, start time: for people, never read by the simulation
};

struct HashMark {
  std::uint64_t tick = 0, hash = 0;
};
struct Keyframe {
  std::uint64_t tick = 0;
  std::vector<std::uint8_t> bytes;
};

struct Recording {
  RecordingHeader header;
  std::vector<Input> inputs;  ///< inputs[i] is that of tick i
  std::vector<HashMark> hashes;
  std::vector<Keyframe> keyframes;
  std::string result_json;  ///< empty if the attempt was interrupted
  bool complete = false;    ///< an end mark was found and every block was sound
  std::string damage;       ///< empty, or what was wrong with the tail and from which byte
};

class RecordingWriter {
 public:
  RecordingWriter(const std::filesystem::path& path, const RecordingHeader& header);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  void tick(std::uint64_t tick, const Input& input);
  void hash(std::uint64_t tick, std::uint64_t hash);
  void keyframe(std::uint64_t tick, std::span<const std::uint8_t> bytes);
  void flush();
  void finish(const std::string& result_json);
  const std::string& failure() const { return m_failure; }  ///< empty, or why nothing more is written (disk full)

 private:
  void write_block(std::uint32_t kind, std::uint64_t first_tick, std::uint64_t count,
                   std::span<const std::uint8_t> payload);
  std::FILE* m_file = nullptr;
  std::string m_failure;
  std::vector<std::uint8_t> m_inputs;
  std::uint64_t m_first_tick = 0, m_ticks = 0, m_repeat = 0;
  Input m_last;
};

/// @throws core::BadInput when the header is not a recording's
Recording read_recording(const std::filesystem::path& path);

}  // namespace trocar::sim
