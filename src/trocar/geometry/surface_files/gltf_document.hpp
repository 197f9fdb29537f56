// A glTF file as far as surfaces need it: its JSON, and the bytes that this points to. Used by gltf_*.cpp only.
//
//   .glb   "glTF" uint32 version, length; then chunks: uint32 length, type, bytes; the first JSON, the second binary
//   .gltf  the JSON; buffers as data URIs in it, or as files beside it
//
// [Khronos: glTF 2.0 Specification, 2021]
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/surface_files/json_items.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>

namespace trocar::geometry {

class GltfDocument {
 public:
  GltfDocument(MeshSource& in, const FilesBeside& beside);

  MeshSource& in() { return m_in; }
  const JsonItems& json() const { return m_json; }
  bool in_one_file() const { return m_in_one_file; }  ///< .glb
  std::size_t bytes_behind() const { return m_chunks.behind; }

  /// The values of one of the root's lists: "nodes", "accessors". Nothing where there is none.
  const std::vector<int>& list(std::string_view name);
  /// The value that `object[key]` names by its number in a list; -1 where there is no such key, or after a fault.
  int named(int object, std::string_view key, std::string_view list_name);
  /// Its number, not negative. Nothing where there is no such key, or after a fault.
  std::optional<std::size_t> whole(int object, std::string_view key);
  void fault(int item, std::string message) { m_in.fault(m_json.place(item), std::move(message)); }

  /// The bytes of a buffer view, from `offset` on; nothing after a fault.
  std::optional<std::string_view> view(int buffer_view, std::size_t offset);

 private:
  struct Chunks {
    std::string_view json, binary;
    std::size_t behind = 0;  ///< bytes of the file behind the last one
  };
  struct Buffer {
    int item = -1;
    bool looked_for = false;
    std::optional<std::string_view> bytes;
  };
  MeshSource& m_in;
  const FilesBeside& m_beside;
  bool m_in_one_file;
  Chunks m_chunks;
  JsonItems m_json;
  std::vector<std::pair<std::string, std::vector<int>>> m_lists;
  std::vector<Buffer> m_buffers;
  std::vector<std::unique_ptr<std::string>> m_own;  ///< what buffers look at that is not in the file as it is
  std::size_t m_own_bytes = 0;

  static Chunks chunks_of(MeshSource& in);
  std::optional<std::string_view> buffer(int item);
  std::optional<std::string_view> load(int item);
  std::optional<std::string_view> load_uri(int uri);
};

}  // namespace trocar::geometry
