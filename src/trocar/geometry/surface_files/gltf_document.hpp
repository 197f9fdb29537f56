// A glTF file as far as surfaces need it: its JSON, and the bytes that this points to. Used by gltf_*.cpp only.
//
//   .glb   "glTF" uint32 version, length; then chunks: uint32 length, type, bytes; the first JSON, the second binary
//   .gltf  the JSON; buffers as data URIs in it, or as files beside it
//
// [Khronos: glTF 2.0 Specification, 2021]
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/json/json_reader.hpp>
#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>

namespace trocar::geometry {

/// A value of the JSON; null for none.
using GltfItem = const core::JsonValue*;

class GltfDocument {
 public:
  GltfDocument(MeshSource& in, const FilesBeside& beside);

  MeshSource& in() { return m_in; }
  GltfItem root() const { return &m_json.root; }
  /// Of an object the value of a key; null for none, and of what is no object.
  static GltfItem member(GltfItem object, std::string_view key);
  /// Of an array, in order; nothing of other values.
  static std::span<const core::JsonValue> items(GltfItem array);
  bool in_one_file() const { return m_in_one_file; }  ///< .glb
  std::size_t bytes_behind() const { return m_chunks.behind; }

  /// The values of one of the root's lists: "nodes", "accessors". Nothing where there is none.
  std::span<const core::JsonValue> list(std::string_view name);
  /// The value that `object[key]` names by its number in a list; null where there is no such key, or after a fault.
  GltfItem named(GltfItem object, std::string_view key, std::string_view list_name);
  /// Its number, not negative. Nothing where there is no such key, or after a fault.
  std::optional<std::size_t> whole(GltfItem object, std::string_view key);
  std::size_t place(GltfItem item) const { return m_offset + item->from; }  ///< in the file
  void fault(GltfItem item, std::string message) { m_in.fault(place(item), std::move(message)); }
  /// How a fault names a value: "12", "an array"; "none" of null.
  static std::string shown(GltfItem item) { return item ? core::shown(*item) : "none"; }

  /// The bytes of a buffer view, from `offset` on; nothing after a fault.
  std::optional<std::string_view> view(GltfItem buffer_view, std::size_t offset);

 private:
  struct Chunks {
    std::string_view json, binary;
    std::size_t behind = 0;  ///< bytes of the file behind the last one
  };
  struct Buffer {
    GltfItem item = nullptr;
    bool looked_for = false;
    std::optional<std::string_view> bytes;
  };
  MeshSource& m_in;
  const FilesBeside& m_beside;
  bool m_in_one_file;
  Chunks m_chunks;
  std::size_t m_offset;  ///< of the JSON in the file
  core::JsonDocument m_json;
  std::vector<Buffer> m_buffers;
  std::vector<std::unique_ptr<std::string>> m_own;  ///< what buffers look at that is not in the file as it is
  std::size_t m_own_bytes = 0;

  static Chunks chunks_of(MeshSource& in);
  std::optional<std::string_view> buffer(GltfItem item);
  std::optional<std::string_view> load(GltfItem item);
  std::optional<std::string_view> load_uri(GltfItem uri);
};

}  // namespace trocar::geometry
