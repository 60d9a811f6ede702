// A Markdown page with a section for each recording that was evaluated.
#pragma once

#include <string>
#include <string_view>

namespace accrete::cli {

// `page` with the section `## title` replaced by `body`, or with it added at the end; everything else stays as it was.
// An empty page gets a heading and an introduction. `body` holds no line that begins with "## ".
[[nodiscard]] std::string with_section(std::string_view page, std::string_view title, std::string_view body);

}  // namespace accrete::cli
