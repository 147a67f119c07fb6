#include "base/text_head.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/file.h"

namespace velour {
namespace {

/// Collects the bytes of a text that are not part of comments.
class TextHead {
 public:
  explicit TextHead(Comments comments) : comments_(comments) {}

  const std::string& text() const { return text_; }

  void add(char c) {
    if (in_comment_) return add_comment(c);
    if (is_space(c)) {
      gap_ = is_line_end(c) || gap_ == '\n' ? '\n' : ' ';
    } else if (c == '#' && begins_comment()) {
      in_comment_ = true;
    } else if (comments_ != Comments::xml) {
      add_text(c);
    } else if (!is_part_of_utf16(c)) {
      add_text(c);
      begin_xml_comment("<!--", "-->");
      begin_xml_comment("<?", "?>");
    }
  }

 private:
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  /// Byte order marks and the upper bytes of ASCII; none of them occurs in UTF-8.
  static bool is_part_of_utf16(char c) { return c == '\0' || c == '\xfe' || c == '\xff'; }

  bool begins_comment() const {
    return comments_ == Comments::hash || (comments_ == Comments::hash_lines && (text_.empty() || gap_ == '\n'));
  }

  void add_text(char c) {
    if (gap_ != '\0' && !text_.empty() && !is_space(text_.back())) text_ += gap_;
    gap_ = '\0';
    text_ += c;
  }

  void begin_xml_comment(std::string_view begin, std::string_view end) {
    if (!text_.ends_with(begin)) return;
    text_.resize(text_.size() - begin.size());
    in_comment_ = true;
    end_ = end;
    last_.clear();
  }

  void add_comment(char c) {
    if (comments_ != Comments::xml) {
      in_comment_ = !is_line_end(c);
      if (!in_comment_) gap_ = '\n';
      return;
    }
    if (is_part_of_utf16(c)) return;
    if (last_.size() == end_.size()) last_.erase(0, 1);
    last_ += c;
    in_comment_ = last_ != end_;
  }

  Comments comments_;
  std::string text_;
  char gap_ = '\0';  // white space since the last byte of the text, if any
  bool in_comment_ = false;
  std::string_view end_;  // ends the XML comment
  std::string last_;      // last bytes of the XML comment
};

}  // namespace

std::string read_text_head(const std::string& path, size_t count, Comments comments) {
  constexpr uint64_t kBlock = 1 << 16;
  constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
  const RandomAccessFile file(path);
  TextHead head(comments);
  std::vector<uint8_t> block;
  for (uint64_t at = 0; at < file.size(); at += block.size()) {
    block.resize(std::min(kBlock, file.size() - at));
    file.read(at, block);
    std::string_view text(reinterpret_cast<const char*>(block.data()), block.size());
    if (at == 0 && text.starts_with(kUtf8Mark)) text.remove_prefix(kUtf8Mark.size());
    for (const char c : text) {
      head.add(c);
      if (head.text().size() >= count) return head.text().substr(0, count);
    }
  }
  return head.text();
}

}  // namespace velour
