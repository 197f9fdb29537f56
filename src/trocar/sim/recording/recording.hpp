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
// Numbers are little-endian. A block that fails its checksum ends the readable part: `complete` is then false. After
// every block the bytes are handed to the operating system, so a killed process loses less than a second; what a power
// cut takes is the file system's affair. The layout, byte by byte, is at the top of recording.cpp.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <trocar/core/tick.hpp>
#include <trocar/sim/recording/input_code.hpp>

namespace trocar::sim {

inline constexpr int kHashEvery = 100;      ///< ticks between state hashes
inline constexpr int kKeyframeEvery = 100;  ///< ticks between display keyframes (10 Hz)

inline constexpr std::uint32_t kRecordingFormat = 2;
inline constexpr std::uint64_t kMaxTicks =
    4 * 3600 * core::kTicksPerSecond;  ///< a recording's length: four hours (2.2 GB of Input)

struct RecordingHeader {
  std::uint32_t format = kRecordingFormat;
  std::uint64_t model_hash = 0;  ///< of the Model it was made with: another physics refuses to verify
  std::uint64_t seed = 0;
  std::string exercise;  ///< name under scenes/ or path
  std::string program_version;
  std::string metadata_json;  ///< trainee, input device, start time, the exercise's hash: never read by the simulation
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
  std::string result_json;   ///< empty if the attempt was interrupted
  bool complete = false;     ///< an end mark was found and every block was sound
  bool interrupted = false;  ///< every block was sound, but there is no end mark: the program was killed
  std::string damage;        ///< empty, or what was wrong with the tail and from which byte
};

/// Writes one recording. In the loop nothing is thrown: the first fault ends the recording and stands in failure().
class RecordingWriter {
 public:
  /// Creates or replaces the file.  @throws core::EnvironmentLacks with the path and what the system said
  RecordingWriter(const std::filesystem::path& path, const RecordingHeader& header);
  ~RecordingWriter();  ///< flushes; without finish() the recording reads as interrupted
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// The input of the next tick: `tick` counts 0, 1, 2 ... without a gap.
  void tick(std::uint64_t tick, const Input& input);
  /// Of the state that has taken the first `tick` inputs, which must have been written.
  void hash(std::uint64_t tick, std::uint64_t hash);
  void keyframe(std::uint64_t tick, std::span<const std::uint8_t> bytes);  ///< `tick` as for hash()
  void flush();
  void finish(const std::string& result_json);              ///< the end mark; nothing can follow it
  const std::string& failure() const { return m_failure; }  ///< empty, or why nothing more is written (disk full)

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool open() const { return m_file && m_failure.empty(); }
  std::uint64_t ticks() const { return m_first_tick + m_inputs.count(); }
  bool accepts_mark(std::uint64_t tick);
  void fail(const std::string& what);
  void write_block(std::uint32_t kind, std::uint64_t first_tick, std::uint64_t count,
                   std::span<const std::uint8_t> payload);

  std::unique_ptr<std::FILE, CloseFile> m_file;
  std::string m_path, m_failure;
  InputCode m_inputs;                  ///< not yet in the file
  std::vector<std::uint8_t> m_hashes;  ///< coded, not yet in the file
  std::uint64_t m_first_tick = 0;      ///< of m_inputs
};

/// Memory is bounded by the file's size and by kMaxTicks, whatever the bytes are.
/// @throws core::BadInput when the file cannot be read or its header is not a sound recording's of format
/// kRecordingFormat
Recording read_recording(const std::filesystem::path& path);
/// The same from bytes in memory; faults call them `name`.
Recording read_recording(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace trocar::sim
