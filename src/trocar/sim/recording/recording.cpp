// The file: 8 bytes of signature, then blocks until the end. A block is
//   u32 magic  u32 kind  u64 first_tick  u64 count  u64 payload_size  u64 checksum  payload
// checksum = XXH3(payload, seed = XXH3 of the 32 bytes before it). Kinds and their payloads:
//   HEAD  u32 format, u64 model_hash, u64 seed, then exercise, program_version, metadata_json as u32 size + bytes
//   INPT  `count` ticks from first_tick, see input_code.hpp
//   HASH  `count` pairs u64 tick, u64 hash
//   KEYF  the bytes that the caller gave, of tick first_tick
//   END   the result, JSON; first_tick = number of ticks; nothing may follow
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include <trocar/core/byte_code.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::sim {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature = {0x93, 'T', 'R', 'O', 'C', 'A', 'R', '\n'};
constexpr std::uint32_t kBlockMagic = 0x4b424352;                // "RCBK"
constexpr std::uint64_t kTicksPerBlock = core::kTicksPerSecond;  // what a killed process can lose
constexpr std::size_t kBlockHead = 40, kCheckedHead = 32;

enum Kind : std::uint32_t { kHead = 1, kInputs = 2, kHashes = 3, kKeyframe = 4, kEnd = 5 };

using core::ByteReader;
using Bytes = core::ByteString;
using ConstBytes = core::ByteView;

std::uint64_t checksum(ConstBytes checked_head, ConstBytes payload) {
  return core::hash_bytes(payload.data(), payload.size(), core::hash_bytes(checked_head.data(), checked_head.size()));
}

std::string text_of(ConstBytes bytes) { return {bytes.begin(), bytes.end()}; }

// --- the header ---

Bytes coded(const RecordingHeader& header) {
  Bytes bytes;
  core::put(bytes, header.format);
  core::put(bytes, header.model_hash);
  core::put(bytes, header.seed);
  core::put_text(bytes, header.exercise);
  core::put_text(bytes, header.program_version);
  core::put_text(bytes, header.metadata_json);
  return bytes;
}

std::optional<RecordingHeader> decoded_header(ConstBytes bytes) {
  ByteReader from(bytes);
  RecordingHeader header;
  header.format = from.get<std::uint32_t>();
  if (header.format != kRecordingFormat) return header;  // the rest is not ours to read
  header.model_hash = from.get<std::uint64_t>();
  header.seed = from.get<std::uint64_t>();
  header.exercise = from.text();
  header.program_version = from.text();
  header.metadata_json = from.text();
  if (!from.sound() || !from.at_end()) return std::nullopt;
  return header;
}

// --- the reader ---

struct Block {
  std::uint32_t kind = 0;
  std::uint64_t first_tick = 0, count = 0;
  Bytes payload;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : m_path(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
      reject(error ? error.message() : "expected a recording, this is not a regular file");
    m_size = std::filesystem::file_size(path, error);
    if (error) reject(error.message());
    m_file.reset(std::fopen(path.c_str(), "rb"));
    if (!m_file) reject(std::strerror(errno));
  }
  Reader(ConstBytes bytes, const std::string& name) : m_path(name), m_size(bytes.size()) {
    if (bytes.empty()) reject("expected a Trocar recording, got nothing");
    m_file.reset(fmemopen(const_cast<std::uint8_t*>(bytes.data()), bytes.size(), "rb"));  // only read from
    if (!m_file) reject(std::strerror(errno));
  }

  Recording read() {
    Recording recording;
    recording.header = read_header();
    while (m_at < m_size && take(recording)) {
    }
    recording.interrupted = recording.damage.empty() && !recording.complete;
    if (recording.interrupted) recording.damage = at_byte(m_at) + "the recording was interrupted: expected an end mark";
    return recording;
  }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void reject(const std::string& what) const {
    throw core::BadInput({core::Fault{core::Location{m_path.string(), 0, 0}, what}});
  }

  static std::string at_byte(std::uint64_t byte) { return "byte " + std::to_string(byte) + ": "; }

  bool bytes(std::uint8_t* to, std::size_t size) { return size == 0 || std::fread(to, 1, size, m_file.get()) == size; }

  RecordingHeader read_header() {
    std::array<std::uint8_t, kSignature.size()> signature{};
    if (!bytes(signature.data(), signature.size()) || signature != kSignature)
      reject("expected a Trocar recording, the file starts with other bytes");
    m_at = signature.size();
    Block block;
    const std::string fault = read_block(block);
    if (!fault.empty()) reject("damaged header, " + at_byte(m_at) + fault);
    if (block.kind != kHead) reject("expected the header first, got a block of kind " + std::to_string(block.kind));
    const auto header = decoded_header(block.payload);
    if (!header) reject("damaged header: its fields do not fill it");
    if (header->format != kRecordingFormat)
      reject("expected recording format " + std::to_string(kRecordingFormat) + ", got " +
             std::to_string(header->format));
    return *header;
  }

  /// Reads the block at m_at and moves behind it; otherwise says what is wrong with it and stays.
  std::string read_block(Block& block) {
    if (m_size - m_at < kBlockHead) return "the file ends within a block's head";
    std::array<std::uint8_t, kBlockHead> head;
    if (!bytes(head.data(), head.size())) return "cannot be read";
    ByteReader from(head);
    if (from.get<std::uint32_t>() != kBlockMagic) return "expected a block, got other bytes";
    block.kind = from.get<std::uint32_t>();
    block.first_tick = from.get<std::uint64_t>();
    block.count = from.get<std::uint64_t>();
    const auto size = from.get<std::uint64_t>();
    if (size > m_size - m_at - kBlockHead) return "the file ends within a block";
    block.payload.resize(size);
    if (!bytes(block.payload.data(), size)) return "cannot be read";
    if (checksum({head.data(), kCheckedHead}, block.payload) != from.get<std::uint64_t>())
      return "the block's checksum does not match its bytes";
    m_at += kBlockHead + size;
    return {};
  }

  /// Takes the next block into the recording; false at the end of the readable part.
  bool take(Recording& recording) {
    const std::uint64_t start = m_at;
    Block block;
    std::string fault = read_block(block);
    if (fault.empty()) fault = add(block, recording);
    if (fault.empty() && recording.complete && m_at != m_size) fault = "expected nothing behind the end mark";
    if (fault.empty()) return !recording.complete;
    recording.damage = at_byte(start) + fault;
    recording.complete = false;
    return false;
  }

  static std::string add(Block& block, Recording& recording) {
    const std::uint64_t ticks = recording.inputs.size();
    switch (block.kind) {
      case kInputs:
        if (block.first_tick != ticks) return "expected the inputs from tick " + std::to_string(ticks);
        if (block.count == 0 || block.count > kTicksPerBlock || ticks + block.count > kMaxTicks)
          return "more ticks than a recording may hold";
        return append_inputs(block.payload, block.count, recording.inputs) ? "" : "the inputs are badly encoded";
      case kHashes:
        return add_hashes(block, recording);
      case kKeyframe:
        if (block.first_tick > ticks) return "a keyframe of a missing tick";
        recording.keyframes.push_back({block.first_tick, std::move(block.payload)});
        return {};
      case kEnd:
        if (block.first_tick != ticks) return "expected the end mark of tick " + std::to_string(ticks);
        recording.result_json = text_of(block.payload);
        recording.complete = true;
        return {};
      default:
        return "unknown block kind " + std::to_string(block.kind);
    }
  }

  static std::string add_hashes(const Block& block, Recording& recording) {
    if (block.count != block.payload.size() / 16 || block.payload.size() % 16) return "the hashes are badly encoded";
    ByteReader from(block.payload);
    for (std::uint64_t i = 0; i < block.count; ++i) {
      HashMark mark;
      mark.tick = from.get<std::uint64_t>();
      mark.hash = from.get<std::uint64_t>();
      if (mark.tick > recording.inputs.size()) return "a hash of a missing tick";
      recording.hashes.push_back(mark);
    }
    return {};
  }

  std::filesystem::path m_path;
  std::unique_ptr<std::FILE, CloseFile> m_file;
  std::uint64_t m_size = 0, m_at = 0;
};

}  // namespace

// --- the writer ---

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const RecordingHeader& header)
    : m_file(std::fopen(path.c_str(), "wb")), m_path(path.string()) {
  if (!m_file) fail(std::strerror(errno));
  m_inputs.reserve(kTicksPerBlock);
  m_hashes.reserve(16 * kTicksPerBlock);
  if (open() && std::fwrite(kSignature.data(), 1, kSignature.size(), m_file.get()) != kSignature.size())
    fail(std::strerror(errno));
  write_block(kHead, 0, 0, coded(header));
  if (!m_failure.empty()) throw core::EnvironmentLacks(m_failure);
}

RecordingWriter::~RecordingWriter() { flush(); }

void RecordingWriter::tick(std::uint64_t tick, const Input& input) {
  if (!open()) return;
  if (tick != ticks()) return fail("expected tick " + std::to_string(ticks()) + ", got " + std::to_string(tick));
  if (tick >= kMaxTicks) return fail("the recording is full: " + std::to_string(kMaxTicks) + " ticks");

  m_inputs.add(input);
  if (m_inputs.count() == kTicksPerBlock) flush();
}

void RecordingWriter::hash(std::uint64_t tick, std::uint64_t hash) {
  if (!accepts_mark(tick)) return;
  core::put(m_hashes, tick);
  core::put(m_hashes, hash);
}

void RecordingWriter::keyframe(std::uint64_t tick, std::span<const std::uint8_t> bytes) {
  if (!accepts_mark(tick)) return;
  flush();  // so that a mark always stands behind the inputs that led to it
  write_block(kKeyframe, tick, 1, bytes);
}

void RecordingWriter::flush() {
  if (const std::uint64_t count = m_inputs.count(); count > 0) {
    write_block(kInputs, m_first_tick, count, m_inputs.bytes());
    m_inputs.clear();
    m_first_tick += count;
  }
  if (!m_hashes.empty()) {
    write_block(kHashes, m_first_tick, m_hashes.size() / 16, m_hashes);
    m_hashes.clear();
  }
}

void RecordingWriter::finish(const std::string& result_json) {
  flush();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(result_json.data());
  write_block(kEnd, ticks(), 0, {bytes, result_json.size()});
  if (open() && std::fclose(m_file.release()) != 0) fail(std::strerror(errno));
}

bool RecordingWriter::accepts_mark(std::uint64_t tick) {
  if (open() && tick > ticks())
    fail("expected a tick up to " + std::to_string(ticks()) + ", got " + std::to_string(tick));
  return open();
}

void RecordingWriter::fail(const std::string& what) {
  if (m_failure.empty()) m_failure = m_path + ": the recording ends here: " + what;
}

void RecordingWriter::write_block(std::uint32_t kind, std::uint64_t first_tick, std::uint64_t count,
                                  std::span<const std::uint8_t> payload) {
  if (!open()) return;
  Bytes head;
  head.reserve(kBlockHead);
  core::put(head, kBlockMagic);
  core::put(head, kind);
  core::put(head, first_tick);
  core::put(head, count);
  core::put(head, std::uint64_t(payload.size()));
  core::put(head, checksum(head, payload));
  const auto wrote = [file = m_file.get()](ConstBytes bytes) {
    return bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  };
  if (!wrote(head) || !wrote(payload) || std::fflush(m_file.get()) != 0) fail(std::strerror(errno));
}

Recording read_recording(const std::filesystem::path& path) { return Reader(path).read(); }
Recording read_recording(ConstBytes bytes, const std::string& name) { return Reader(bytes, name).read(); }

}  // namespace trocar::sim
