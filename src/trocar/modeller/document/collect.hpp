// A document with everything that it names, for another folder: texts whose names lead to what lies beside them, and
// files of surfaces, meshes and voxels to be copied. Files of the installed folder `scenes` are not taken along: they
// are named by "scenes/...", which leads there wherever the program is installed.
//
//   const Collection sent = collected(document, "to_send/liver.json");
//   write_collection(sent);
#pragma once

#include <utility>
#include <vector>

#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

struct Collection {
  fs::path root;                                      ///< the document's file there
  Texts texts;                                        ///< of it and of the files that it names
  std::vector<std::pair<fs::path, fs::path>> copies;  ///< from, to: all other files
  std::vector<std::string> missing;                   ///< names that lead nowhere
};

/// For a document whose file shall be `root`. Names of files that are taken there by something else get a number.
/// @param tree_stays  files of the tree that `root` lies in stay where they are; else only those of its folder and
/// below
Collection collected(const Document& document, const fs::path& root, bool tree_stays = false);

/// The copies alone. @throws core::BadInput for files that cannot be read or written
void copy_files(const Collection& collection);
/// Writes all of it, the document's own file last. @throws core::BadInput for files that cannot be written
void write_collection(const Collection& collection);

/// What the trainer opens in place of a document that is saved nowhere, or of an organ alone: a scene with all of it,
/// in a folder that is emptied first. @return the scene's file  @throws core::BadInput
fs::path write_scene_for_trainer(const Document& document, const fs::path& folder);

}  // namespace trocar::modeller
