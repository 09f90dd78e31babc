// Text that came from anywhere, made safe for a page: nothing of it can become markup or script.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace servodx::report {

// For element content and for attribute values in double quotes.
std::string escape_html(std::string_view text);

// JSON that may stand inside <script type="application/json">: ASCII, without '<', so it cannot end the element.
std::string script_json(const nlohmann::ordered_json& json);

}  // namespace servodx::report
