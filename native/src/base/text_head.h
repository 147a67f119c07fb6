// The beginning of a text file behind its comments, which may be as long as a license or a lab report.
#pragma once

#include <cstddef>
#include <string>

namespace velour {

enum class Comments {
  hash,        // from '#' to the end of the line
  hash_lines,  // lines that begin with '#'; elsewhere '#' is text
  xml,         // <!-- --> and <? ?>
};

/// The first `count` bytes of a text file without its UTF-8 mark and its comments. White space is reduced to one line
/// feed or blank. XML in UTF-16 is read as ASCII. Reads block by block until there is enough text, if necessary to the
/// end of the file. Throws Error(io).
std::string read_text_head(const std::string& path, size_t count, Comments comments);

}  // namespace velour
