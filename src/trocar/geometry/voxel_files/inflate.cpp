#include <algorithm>

#include <fmt/format.h>
#include <zlib.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/header_fields.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kMostRatio = 1032;  // what deflate can make of a byte at best [RFC 1951]
constexpr std::size_t kPart = std::size_t(1) << 20;
constexpr std::size_t kMostBehind = std::size_t(64) << 20;  // unpacked in well under a second

int window_bits(Wrapping wrapping) {
  return wrapping == Wrapping::gzip ? 15 + 16 : wrapping == Wrapping::zlib ? 15 : -15;
}

class Inflater {
 public:
  Inflater(std::string_view packed, Wrapping wrapping, const std::string& file) : m_left(packed), m_file(file) {
    if (inflateInit2(&m_stream, window_bits(wrapping)) != Z_OK) refuse(file, "expected memory for unpacking, got none");
  }
  ~Inflater() { inflateEnd(&m_stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  std::size_t packed_left() const { return m_left.size() + m_stream.avail_in; }
  /// The packed bytes ended before their own end, where their check sum is.
  bool was_cut() const { return m_cut; }

  using Told = std::function<void(std::size_t done)>;

  /// Fills as much as there is; fewer bytes at the end only.
  std::size_t read(char* out, std::size_t count, const Told& told = {}) {
    std::size_t done = 0;
    while (done < count && !m_ended) {
      if (told) told(done);
      refill();
      m_stream.next_out = reinterpret_cast<Bytef*>(out + done);
      m_stream.avail_out = static_cast<uInt>(std::min(count - done, kPart));
      const uInt before = m_stream.avail_out;
      const int status = inflate(&m_stream, Z_NO_FLUSH);
      done += before - m_stream.avail_out;
      if (status == Z_STREAM_END) {
        next_member();
      } else if (status == Z_BUF_ERROR || (status == Z_OK && before == m_stream.avail_out && packed_left() == 0)) {
        m_ended = m_cut = true;
      } else if (status != Z_OK) {
        refuse(m_file, tr("expected packed data, got damaged ones, {} bytes from the end: copy or download the file "
                          "again",
                          packed_left()));
      }
    }
    return done;
  }
  /// Passes over as much as there is.
  std::size_t drop(std::size_t count, const Told& told) {
    std::vector<char> part(std::min(count, kPart));
    std::size_t done = 0;
    while (done < count) {
      if (told) told(done);
      const std::size_t got = read(part.data(), std::min(part.size(), count - done));
      if (got == 0) break;
      done += got;
    }
    return done;
  }

 private:
  z_stream m_stream{};
  std::string_view m_left;
  std::string m_file;
  bool m_ended = false, m_cut = false;

  void refill() {
    if (m_stream.avail_in > 0 || m_left.empty()) return;
    const std::size_t part = std::min(m_left.size(), kPart);
    // zlib does not write through next_in; its type says so only where ZLIB_CONST is defined.
    m_stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(m_left.data()));
    m_stream.avail_in = static_cast<uInt>(part);
    m_left.remove_prefix(part);
  }
  void next_member() {
    refill();
    const bool more = m_stream.avail_in > 0 && *m_stream.next_in == 0x1f;
    m_ended = !more || inflateReset(&m_stream) != Z_OK;
  }
};

}  // namespace

std::vector<char> inflated(std::string_view packed, Wrapping wrapping, std::size_t from, std::size_t count,
                           const std::string& file) {
  Inflater in(packed, wrapping, file);
  in.drop(from, {});
  std::vector<char> out(std::min(count, kPart));
  std::size_t done = 0;
  while (done < count) {
    if (done == out.size()) out.resize(std::min(count, 2 * out.size()));
    const std::size_t got = in.read(out.data() + done, out.size() - done);
    done += got;
    if (got == 0) break;
  }
  out.resize(done);
  return out;
}

std::vector<char> inflated_part(std::string_view packed, Wrapping wrapping, PackedPart wanted, const std::string& file,
                                const std::function<void(double)>& progress, bool& more) {
  const std::size_t all = wanted.all(), most = packed.size() * kMostRatio + 1024;
  if (all > most)
    refuse(file, tr("expected {} bytes unpacked, got {} packed, which cannot be so many", all, packed.size()));
  std::size_t done = 0;
  const auto tell = [&](std::size_t now) {
    if (progress) progress(double(done + now) / double(all));
  };
  const auto require = [&](std::size_t got, std::size_t part) {
    done += got;
    if (got < part)
      refuse(file, tr("expected {} bytes unpacked, got {}: the file is cut, copy or download it again", all, done));
  };
  Inflater in(packed, wrapping, file);
  require(in.drop(wanted.from, tell), wanted.from);
  std::vector<char> out(wanted.count);
  require(in.read(out.data(), wanted.count, tell), wanted.count);
  require(in.drop(wanted.behind, tell), wanted.behind);
  const std::size_t extra = in.drop(kMostBehind, {});
  if (extra == kMostBehind)
    refuse(file, tr("expected {} bytes unpacked, got {} more and no end of them: unpack the file first", all, extra));
  if (in.was_cut())
    refuse(file, tr("expected packed data up to their check sum, got {} bytes without it: the file is cut, copy or "
                    "download it again",
                    packed.size()));
  more = extra > 0;
  return out;
}

std::string gzipped(std::string_view bytes) {
  z_stream stream{};
  // Level 1: scans are noise, on which the others gain a few per cent in several times the time.
  deflateInit2(&stream, 1, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out;
  std::vector<char> part(kPart);
  int status = Z_OK;
  do {
    if (stream.avail_in == 0 && !bytes.empty()) {
      const std::size_t next = std::min(bytes.size(), kPart);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(next);
      bytes.remove_prefix(next);
    }
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    status = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    out.append(part.data(), part.size() - stream.avail_out);
  } while (status == Z_OK || status == Z_BUF_ERROR);
  deflateEnd(&stream);
  return out;
}

}  // namespace trocar::geometry
