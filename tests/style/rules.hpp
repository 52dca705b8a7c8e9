// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace headland::style {

/// A file of the tree, by its path from the root with forward slashes.
struct SourceFile {
  std::string path;
  std::string text;
};

/// Complaints, each `path:line: what`; empty if the rule holds.
using Complaints = std::vector<std::string>;

/// All text files below the folders of the project; no build outputs, no hidden folders but .ci.
std::vector<SourceFile> read_tree(const std::filesystem::path& root);

/// DESIGN section 2: which folder may include which folder and which library.
Complaints check_layering(const SourceFile& file);
/// No file over 600 lines, no function over 80 (found by its braces).
Complaints check_size(const SourceFile& file);
/// Source, script and build files name their licence in one of the first two lines.
Complaints check_licence(const SourceFile& file);
/// Keys of doubles that a visit() lists end in their unit, or are known to have none.
Complaints check_units(const SourceFile& file);
/// No flag that ties the build to one processor or loosens floating point.
Complaints check_flags(const SourceFile& file);
/// No path of the machine that the text was written on.
Complaints check_machine_paths(const SourceFile& file);
/// Each folder of code, and each module in it, has a README.md.
Complaints check_readmes(const std::vector<SourceFile>& tree);
/// Each file that a table row of docs/papers.md names exists.
Complaints check_papers(const SourceFile& papers, const std::vector<SourceFile>& tree);

/// The text with comments and the contents of literals blanked; line breaks stay.
std::string without_literals(std::string_view text);

}  // namespace headland::style
