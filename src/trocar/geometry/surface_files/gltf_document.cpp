#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/base64.hpp>
#include <trocar/geometry/surface_files/gltf_document.hpp>

namespace trocar::geometry {
namespace {

using Kind = core::JsonValue::Kind;

constexpr int kMostValues = 1'000'000;  // of JSON: one of 100 000 nodes has as many
constexpr std::int64_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

/// Characters that a URI spells as %20.
std::string unescaped(std::string_view uri) {
  std::string out;
  const auto digit = [](char c) {
    const std::size_t at = std::string_view("0123456789abcdef").find(c >= 'A' && c <= 'F' ? char(c - 'A' + 'a') : c);
    return at == std::string_view::npos ? -1 : int(at);
  };
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool code = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    out += code ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
    if (code) i += 2;
  }
  return out;
}

}  // namespace

GltfDocument::Chunks GltfDocument::chunks_of(MeshSource& in) {
  const std::string_view all = in.all();
  if (all.substr(0, 4) != "glTF") return {all.substr(in.at()), {}, 0};
  in.set_form(MeshSource::Form::binary);
  const auto whole = [&](const char* what) {
    std::int64_t value = 0;
    in.integer(value, 4, what);
    return value < 0 ? value + (std::int64_t(1) << 32) : value;
  };
  in.go_to(4);
  if (const std::int64_t version = whole("the version"); version != 2)
    in.lose(4, tr("expected glTF of version 2, got {}", version));
  const std::int64_t all_bytes = whole("the length of the file");
  if (std::uint64_t(all_bytes) > all.size())
    in.lose(8, tr("expected at most the file's length, {}, got {}", all.size(), all_bytes));
  Chunks chunks;
  chunks.behind = all.size() - std::size_t(all_bytes);
  for (int chunk = 0; in.left() > chunks.behind; ++chunk) {
    const std::size_t at = in.at();
    const std::int64_t length = whole("the length of a chunk"), type = whole("the type of a chunk");
    const std::size_t room = in.left() - std::min(in.left(), chunks.behind);
    if (std::uint64_t(length) > room) in.lose(at, tr("expected a chunk of at most {} bytes, got {}", room, length));
    if ((chunk == 0) != (type == kJsonChunk))
      in.lose(at + 4, tr("expected JSON in the first chunk and nowhere else, got {:#010x}", type));
    if (chunk == 0) chunks.json = all.substr(in.at(), std::size_t(length));
    while (chunk == 0 && chunks.json.ends_with('\0')) chunks.json.remove_suffix(1);  // filled up, if not with blanks
    if (chunk == 1 && type == kBinaryChunk) chunks.binary = all.substr(in.at(), std::size_t(length));
    in.skip_bytes(std::uint64_t(length), "a chunk");
  }
  if (!chunks.json.data()) in.lose(all.size(), "expected a chunk of JSON, got the end of the file");
  return chunks;
}

GltfDocument::GltfDocument(MeshSource& in, const FilesBeside& beside)
    : m_in(in),
      m_beside(beside),
      m_in_one_file(in.all().substr(0, 4) == "glTF"),
      m_chunks(chunks_of(in)),
      m_offset(std::size_t(m_chunks.json.data() - in.all().data())) {
  std::vector<core::Fault> faults;
  m_json = core::parse_json(m_chunks.json, in.file(), faults, {.values = kMostValues});
  if (faults.size() > kMaxMeshFaults) faults.resize(kMaxMeshFaults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  if (root()->kind != Kind::object) in.lose(place(root()), tr("expected an object, got {}", shown(root())));
  for (const core::JsonValue& item : list("buffers")) m_buffers.push_back({&item, false, {}});
}

GltfItem GltfDocument::member(GltfItem object, std::string_view key) {
  const core::JsonMember* found = object ? object->find(key) : nullptr;
  return found ? &found->value : nullptr;
}

std::span<const core::JsonValue> GltfDocument::items(GltfItem array) {
  return array ? std::span<const core::JsonValue>(array->items) : std::span<const core::JsonValue>();
}

std::span<const core::JsonValue> GltfDocument::list(std::string_view name) {
  const GltfItem item = member(root(), name);
  if (item && item->kind != Kind::array) m_in.lose(place(item), tr("expected an array, got {}", shown(item)));
  return items(item);
}

std::optional<std::size_t> GltfDocument::whole(GltfItem object, std::string_view key) {
  const GltfItem item = member(object, key);
  if (!item) return std::nullopt;
  constexpr double most = 9007199254740992.0;  // 2^53
  const double value = item->number;
  if (item->kind == Kind::number && value >= 0 && value < most && value == double(static_cast<std::uint64_t>(value)))
    return std::size_t(value);
  fault(item, tr("expected a whole number from 0 on, got {}", shown(item)));
  return std::nullopt;
}

GltfItem GltfDocument::named(GltfItem object, std::string_view key, std::string_view list_name) {
  const std::optional<std::size_t> number = whole(object, key);
  if (!number) return nullptr;
  const std::span<const core::JsonValue> all = list(list_name);
  if (*number < all.size()) return &all[*number];
  fault(member(object, key), tr("expected one of {} {}, got {}", all.size(), list_name, *number));
  return nullptr;
}

std::optional<std::string_view> GltfDocument::view(GltfItem buffer_view, std::size_t offset) {
  const GltfItem buffer_item = named(buffer_view, "buffer", "buffers");
  if (!buffer_item) {
    if (!member(buffer_view, "buffer")) fault(buffer_view, "expected a buffer, got none");
    return std::nullopt;
  }
  const std::size_t from = whole(buffer_view, "byteOffset").value_or(0);
  const std::size_t length = whole(buffer_view, "byteLength").value_or(0);
  const std::optional<std::string_view> bytes = buffer(buffer_item);
  if (!bytes) return std::nullopt;
  if (from <= bytes->size() && length <= bytes->size() - from && offset <= length)
    return bytes->substr(from + offset, length - offset);
  fault(buffer_view, tr("expected a view within the buffer's {} bytes, got {} from {} on, read from {} on",
                        bytes->size(), length, from, offset));
  return std::nullopt;
}

std::optional<std::string_view> GltfDocument::buffer(GltfItem item) {
  const auto found = std::find_if(m_buffers.begin(), m_buffers.end(), [&](const Buffer& b) { return b.item == item; });
  if (found->looked_for) return found->bytes;
  found->looked_for = true;
  found->bytes = load(item);
  const std::size_t length = whole(item, "byteLength").value_or(0);
  if (found->bytes && found->bytes->size() < length) {
    fault(item, tr("expected a buffer of {} bytes, got {}", length, found->bytes->size()));
    found->bytes.reset();
  }
  return found->bytes;
}

std::optional<std::string_view> GltfDocument::load(GltfItem item) {
  const GltfItem uri = member(item, "uri");
  if (uri && uri->kind == Kind::string) return load_uri(uri);
  if (m_in_one_file && item == m_buffers.front().item && m_chunks.binary.data()) return m_chunks.binary;
  fault(item, "expected a buffer with a uri, or a binary chunk, got neither");
  return std::nullopt;
}

std::optional<std::string_view> GltfDocument::load_uri(GltfItem uri) {
  const std::string_view raw = uri->text;
  std::optional<std::string> bytes;
  if (raw.substr(0, 5) == "data:") {
    constexpr std::string_view form = ";base64,";
    const std::size_t at = raw.substr(0, 200).find(form);
    if (at != raw.npos) bytes = from_base64(raw.substr(at + form.size()));
    if (!bytes) fault(uri, tr("expected data in base64, got {}", shown(uri)));
  } else if (!m_beside) {
    fault(uri, tr("expected data in the file itself, got {}", shown(uri)));
  } else {
    bytes = m_beside(unescaped(raw));
  }
  if (!bytes) return std::nullopt;
  m_own_bytes += bytes->size();
  if (m_own_bytes > 2 * kMaxMeshBytes)
    m_in.lose(place(uri), tr("expected at most {} bytes in buffers, got more", 2 * kMaxMeshBytes));
  m_own.push_back(std::make_unique<std::string>(std::move(*bytes)));
  return std::string_view(*m_own.back());
}

}  // namespace trocar::geometry
