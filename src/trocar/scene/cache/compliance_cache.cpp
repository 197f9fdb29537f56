#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/cache/compliance_cache.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kFormat = 1;  // of the file, and of the arithmetic that fills it
constexpr std::array<char, 8> kMagic{'T', 'R', 'O', 'C', 'A', 'R', 'C', 'O'};
constexpr const char* kEnding = ".compliance";

/// At the beginning of a file; numbers as this machine has them, given by `order`.
struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t order = 0x01020304;
  ContentKey key;
  std::uint32_t kept = 0, fields = 0;
  std::uint64_t sum = 0;  ///< of all that follows
};
static_assert(sizeof(Header) == 48, "no padding");

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

fs::path file_of(ContentKey key) {
  const fs::path folder = compliance_folder();
  return folder.empty() ? fs::path() : folder / (core::hex(key.a) + core::hex(key.b) + kEnding);
}

std::uint64_t sum_of(const Compliance& c) {
  core::Hasher h;
  h.add(c.columns);
  h.add(c.fields);
  return h.value();
}

std::string damage_in(const Header& h, const Header& wanted, std::size_t size, std::size_t wanted_size) {
  if (h.magic != kMagic) return "it is not a compliance file";
  if (h.format != kFormat) return "its format has another version";
  if (h.order != wanted.order) return "it is from a machine with another number format";
  if (h.key.a != wanted.key.a || h.key.b != wanted.key.b || h.kept != wanted.kept || h.fields != wanted.fields)
    return "it belongs to another organ";
  if (size != wanted_size) return tr("it has {} bytes instead of {}", size, wanted_size);
  return "";
}

template <class Values>
void hash_content(core::Hasher& h, const Values& values) {
  h.add(std::uint64_t(values.size()));
  h.add_bytes(values.data(), values.size() * sizeof(values[0]));
}

}  // namespace

ContentKey content_key(const tissue::Stiffness& k, std::span<const int> kept, std::span<const double> loads) {
  const auto hashed = [&](std::uint64_t seed) {
    core::Hasher h;
    h.add(seed);
    h.add(kFormat);
    hash_content(h, k.points);
    hash_content(h, k.held);
    hash_content(h, k.first);
    hash_content(h, k.column);
    hash_content(h, k.block);
    hash_content(h, kept);
    hash_content(h, loads);
    return h.value();
  };
  return {hashed(0x7472), hashed(0x6f63)};
}

fs::path compliance_folder() {
  if (const std::string named = environment("TROCAR_CACHE"); !named.empty()) return named;
  if (const std::string cache = environment("XDG_CACHE_HOME"); !cache.empty()) return fs::path(cache) / "trocar";
  if (const std::string home = environment("HOME"); !home.empty()) return fs::path(home) / ".cache" / "trocar";
  return {};
}

CachedCompliance read_compliance(ContentKey key, int kept, int fields) {
  CachedCompliance out;
  out.file = file_of(key);
  std::error_code error;
  if (out.file.empty() || !fs::exists(out.file, error)) return out;
  const std::size_t columns = 9 * std::size_t(kept) * std::size_t(kept),
                    more = 3 * std::size_t(kept) * std::size_t(fields);
  const std::size_t size = sizeof(Header) + (columns + more) * sizeof(float);
  std::string bytes;
  try {
    bytes = core::read_file(out.file, size);
  } catch (const core::BadInput& e) {
    out.damage = e.faults().front().message;
    return out;
  }
  Header header, wanted;
  wanted.key = key, wanted.kept = std::uint32_t(kept), wanted.fields = std::uint32_t(fields);
  std::memcpy(&header, bytes.data(), std::min(bytes.size(), sizeof header));
  out.damage = bytes.size() < sizeof header ? "it is too short" : damage_in(header, wanted, bytes.size(), size);
  if (!out.damage.empty()) return out;
  out.compliance.columns.resize(columns);
  out.compliance.fields.resize(more);
  const char* from = bytes.data() + sizeof header;
  std::memcpy(out.compliance.columns.data(), from, columns * sizeof(float));
  if (more > 0) std::memcpy(out.compliance.fields.data(), from + columns * sizeof(float), more * sizeof(float));
  out.found = sum_of(out.compliance) == header.sum;
  if (!out.found) out.damage = "its content is damaged", out.compliance = {};
  if (out.found) fs::last_write_time(out.file, fs::file_time_type::clock::now(), error);  // it was used
  return out;
}

std::string keep_compliance(ContentKey key, int kept, const Compliance& c) {
  const fs::path file = file_of(key);
  if (file.empty()) return "there is no folder for it (set TROCAR_CACHE)";
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  Header header;
  header.key = key;
  header.kept = std::uint32_t(kept);
  header.fields = std::uint32_t(c.fields.size() / (3 * std::size_t(std::max(1, kept))));
  header.sum = sum_of(c);
  const auto bytes_of = [](const std::vector<float>& values) {
    return std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  };
  const std::string_view head(reinterpret_cast<const char*>(&header), sizeof header);
  if (const std::string said = core::write_file(file, {head, bytes_of(c.columns), bytes_of(c.fields)}); !said.empty())
    return "cannot write to " + file.parent_path().string() + " (" + said + ")";
  trim_compliances(file.parent_path(), kMostCachedBytes);
  return "";
}

void trim_compliances(const fs::path& folder, std::uintmax_t most) {
  core::remove_unfinished(folder);
  struct Kept {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path path;
  };
  std::vector<Kept> all;
  std::uintmax_t sum = 0;
  std::error_code error;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, error)) {
    if (e.path().extension() != kEnding) continue;
    std::error_code lost;
    const std::uintmax_t bytes = e.file_size(lost);
    const fs::file_time_type used = e.last_write_time(lost);
    if (lost) continue;  // another program took it away
    all.push_back({used, bytes, e.path()});
    sum += bytes;
  }
  std::sort(all.begin(), all.end(), [](const Kept& x, const Kept& y) { return x.used < y.used; });
  for (std::size_t i = 0; i + 1 < all.size() && sum > most; ++i) {
    fs::remove(all[i].path, error);
    sum -= all[i].bytes;
  }
}

}  // namespace trocar::scene
