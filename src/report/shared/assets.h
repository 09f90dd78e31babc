// Text files embedded at build (CMakeLists: servodx_embed): uPlot, the style and script of src/report/shared/web/, the
// list of fields and the page docs/errors.md.
#pragma once
#include <string_view>

namespace servodx::report::assets {

extern const std::string_view chart_script, chart_style, page_script, page_style, field_list, errors_page;

}  // namespace servodx::report::assets
