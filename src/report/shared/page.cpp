#include "report/shared/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/sha256.h"
#include "report/shared/assets.h"
#include "report/shared/handy.h"
#include "report/shared/html.h"
#include "report/shared/page_head.h"
#include "report/shared/plot_samples.h"

namespace servodx::report {
namespace {

const char* name_of(Role role) {
  switch (role) {
    case Role::measured:
      return "measured";
    case Role::reference:
      return "reference";
    case Role::named:
      return "named";
    case Role::other:
      return "other";
    case Role::input:
      return "input";
  }
  return "";
}

const char* name_of(Tone tone) {
  switch (tone) {
    case Tone::plain:
      return "plain";
    case Tone::good:
      return "good";
    case Tone::bad:
      return "bad";
    case Tone::doubt:
      return "doubt";
  }
  return "";
}

std::string exact(double value) {
  std::string digits;
  if (std::isfinite(value)) append_number(digits, value);
  return digits;
}

std::string cell_html(const Cell& cell, char alignment, const char* element = "td") {
  constexpr std::size_t short_words = 16, long_words = 24;  // characters: never broken; broken anywhere if need be
  std::string attributes;
  const bool is_long = cell.text.size() > long_words;
  attributes += alignment == 'r'                  ? (is_long ? " class=\"r long\"" : " class=\"r\"")
                : is_long                         ? " class=\"long\""
                : cell.text.size() <= short_words ? " class=\"short\""
                                                  : "";
  if (cell.tone != Tone::plain) attributes += fmt::format(" data-tone=\"{}\"", name_of(cell.tone));
  if (cell.value) attributes += fmt::format(" data-value=\"{}\"", exact(*cell.value));
  std::string text = escape_html(cell.text);
  if (cell.text.size() > short_words && cell.text.find(' ') == std::string::npos)  // a path breaks behind its folders
    for (std::size_t at = text.find('/'); at != std::string::npos; at = text.find('/', at + 1))
      text.insert(at + 1, "<wbr>");
  if (!cell.link.empty()) text = fmt::format("<a href=\"{}\">{}</a>", escape_html(cell.link), text);
  return fmt::format("<{0}{1}>{2}</{0}>", element, attributes, text);
}

// Numbers of a plot: enough digits for a screen and for a calculation that begins from it.
void append_numbers(std::string& to, const std::vector<double>& v, const std::vector<std::size_t>& kept, int digits) {
  to += '[';
  for (const std::size_t k : kept) {
    if (to.back() != '[') to += ',';
    if (std::isfinite(v[k]))
      fmt::format_to(std::back_inserter(to), "{:.{}g}", v[k], digits);
    else
      to += "null";
  }
  to += ']';
}

// Rows beyond `shown` open on a click.
std::string folded_rows(std::size_t rows, std::size_t shown) {
  return shown > 0 && rows > shown ? fmt::format(" data-shown=\"{}\"", shown) : "";
}

constexpr int digits_of_y = 6, digits_of_x = 9;

void append_marks(std::string& to, const char* key, const std::vector<Mark>& marks) {
  Json all = Json::array();
  for (const Mark& m : marks) all.push_back({{"at", m.at}, {"label", m.label}});
  if (!marks.empty()) to += fmt::format(",\"{}\":{}", key, script_json(all));
}

}  // namespace

Page::Page(const Header& header, std::string title) : header_(header), title_(std::move(title)) {}

void Page::verdict(const Verdict& v, const std::string& id) {
  end_section();
  body_ += fmt::format("<section class=\"verdict\" data-tone=\"{}\"{}>\n<h{} class=\"headline\">", name_of(v.tone),
                       id.empty() ? "" : fmt::format(" id=\"{}\"", escape_html(id)), id.empty() ? 1 : 2);
  if (!v.word.empty()) body_ += fmt::format("<span class=\"word\">{}</span> ", escape_html(v.word));
  body_ += fmt::format("{}</h{}>\n", escape_html(v.headline), id.empty() ? 1 : 2);
  if (!v.detail.empty()) body_ += fmt::format("<p class=\"detail\">{}</p>\n", escape_html(v.detail));
  if (!v.facts.empty()) {
    body_ += "<dl class=\"facts\">";
    for (const auto& [name, value] : v.facts)
      body_ += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", escape_html(name), escape_html(value));
    body_ += "</dl>\n";
  }
  if (!v.reasons.empty()) {
    body_ += "<ul class=\"reasons\">";
    for (const std::string& reason : v.reasons) body_ += fmt::format("<li>{}</li>", escape_html(reason));
    body_ += "</ul>\n";
  }
  body_ += "</section>\n";
}

void Page::end_section() {
  if (in_section_) body_ += folded_ ? "</details>\n" : "</section>\n";
  in_section_ = false;
}

void Page::section(const std::string& title, const std::string& lead, bool folded) {
  end_section();
  in_section_ = true;
  folded_ = folded;
  const std::string id = fmt::format("s{}", ++sections_);
  body_ +=
      folded ? fmt::format("<details class=\"part\" id=\"{}\"><summary><h2>{}</h2></summary>\n", id, escape_html(title))
             : fmt::format("<section class=\"part\" id=\"{}\"><h2>{}</h2>\n", id, escape_html(title));
  if (!lead.empty()) text(lead);
}

void Page::text(const std::string& words) { body_ += fmt::format("<p>{}</p>\n", escape_html(words)); }

std::string Page::csv_button(const std::string& title) const {
  return fmt::format("<button type=\"button\" class=\"csv\" aria-label=\"CSV of {}\">CSV</button>", escape_html(title));
}

void Page::add(const Plot& plot) {
  std::vector<const std::vector<double>*> columns;
  for (const Series& s : plot.series) columns.push_back(&s.y);
  const std::vector<std::size_t> kept = thinned(plot.x, columns, plot.most_rows);

  Json head = {{"x", plot.x_label},   {"x_shown", plot.x_label_shown},
               {"group", plot.group}, {"low", plot.low},
               {"log", plot.log_y},   {"log_x", plot.log_x}};
  head["title"] = plot.title;
  Json series = Json::array();
  for (const Series& s : plot.series)
    series.push_back({{"name", s.name}, {"role", name_of(s.role)}, {"points", s.points}});
  head["series"] = series;
  if (plot.band) head["band"] = plot.band->name;
  std::string data = script_json(head);
  data.pop_back();
  append_marks(data, "xmarks", plot.x_marks);
  append_marks(data, "ymarks", plot.y_marks);
  data += ",\"data\":[";
  append_numbers(data, plot.x, kept, digits_of_x);
  for (const auto* y : columns) {
    data += ',';
    append_numbers(data, *y, kept, digits_of_y);
  }
  if (plot.band)
    for (const auto* y : {&plot.band->lower, &plot.band->upper}) {
      data += ',';
      append_numbers(data, *y, kept, digits_of_y);
    }
  data += "]}";
  data_ += (data_.empty() ? "" : ",\n") + data;

  std::string names;
  for (const Series& s : plot.series) names += (names.empty() ? "" : ", ") + s.name;
  const std::string thin =
      kept.size() < plot.x.size()
          ? fmt::format(" <span class=\"thin\">{} of {} samples, every peak kept</span>", kept.size(), plot.x.size())
          : "";
  body_ += fmt::format(
      "<figure class=\"plot\" data-plot=\"{}\"><figcaption><span>{}{}</span>{}</figcaption>"
      "<div class=\"chart{}\" role=\"group\" aria-roledescription=\"chart\" tabindex=\"0\" "
      "aria-label=\"{}: {}. Plus and minus zoom, arrows move, 0 shows all.\"></div></figure>\n",
      plots_++, escape_html(plot.title), thin, csv_button(plot.title), plot.low ? " low" : "", escape_html(plot.title),
      escape_html(names));
}

void Page::add(const TablePart& table) {
  const auto align = [&](std::size_t c) { return c < table.alignment.size() ? table.alignment[c] : 'l'; };
  body_ +=
      fmt::format("<figure class=\"table\"{}><figcaption><span>{}</span>{}</figcaption><div class=\"wide\"><table>",
                  folded_rows(table.rows.size(), table.shown), escape_html(table.title), csv_button(table.title));
  body_ += "<thead><tr>";
  for (std::size_t c = 0; c < table.head.size(); ++c) body_ += cell_html(table.head[c], align(c), "th");
  body_ += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) body_ += cell_html(row[c], align(c));
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div></figure>\n";
}

void Page::add(const Bars& bars) {
  double full = 0;
  for (const Bars::Row& r : bars.rows)
    if (std::isfinite(r.value)) full = std::max(full, r.value);
  if (bars.mark) full = std::max(full, 1.15 * bars.mark->at);
  full = bars.full.value_or(full);
  const auto part = [&](double v) {
    return full > 0 && std::isfinite(v) ? fmt::format("{:.2f}%", 100 * std::clamp(v / full, 0.0, 1.0)) : "0%";
  };
  bool notes = false;
  for (const Bars::Row& r : bars.rows) notes = notes || !r.note.empty();
  body_ += fmt::format("<figure class=\"bars\"{}><figcaption><span>{}</span>{}</figcaption><div class=\"wide\"><table>",
                       folded_rows(bars.rows.size(), bars.shown), escape_html(bars.title), csv_button(bars.title));
  body_ += fmt::format("<thead><tr><th>{}</th><th class=\"r\">{}</th><th class=\"bar\" aria-hidden=\"true\">{}</th>{}",
                       escape_html(bars.label), escape_html(bars.unit),
                       bars.mark ? fmt::format("<span class=\"mark\" style=\"left:{}\">{}</span>", part(bars.mark->at),
                                               escape_html(bars.mark->label))
                                 : "",
                       notes ? "<th></th>" : "");
  body_ += "</tr></thead><tbody>\n";
  for (const Bars::Row& r : bars.rows) {
    Cell name = r.label;
    name.link = r.link;
    body_ += fmt::format("<tr data-tone=\"{}\">{}<td class=\"r\" data-value=\"{}\">{}</td>", name_of(r.tone),
                         cell_html(name, 'l', "th"), exact(r.value), escape_html(r.text));
    body_ += fmt::format(
        "<td class=\"bar\" aria-hidden=\"true\"><span class=\"fill\" style=\"width:{}\"></span>{}</td>", part(r.value),
        bars.mark ? fmt::format("<span class=\"mark\" style=\"left:{}\"></span>", part(bars.mark->at)) : "");
    if (notes) body_ += fmt::format("<td class=\"note\">{}</td>", escape_html(r.note));
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div></figure>\n";
}

void Page::add(const Moves& moves) {
  // A bar ends at 20 standard errors: beyond that it is certain, and how certain says nothing.
  constexpr double most_sigmas = 20.0;
  double full = 3.0;
  for (const Moves::Row& r : moves.rows)
    if (std::isfinite(r.sigmas)) full = std::max(full, std::min(most_sigmas, std::abs(r.sigmas)));
  body_ +=
      fmt::format("<figure class=\"moves\"{}><figcaption><span>{}</span>{}</figcaption><div class=\"wide\"><table>",
                  folded_rows(moves.rows.size(), moves.shown), escape_html(moves.title), csv_button(moves.title));
  body_ +=
      "<thead><tr><th>parameter</th><th class=\"r\">from</th><th class=\"r\">to</th><th class=\"r\">std. error</th>"
      "<th>unit</th><th class=\"r\">moved, in sigmas</th><th class=\"bar\" aria-hidden=\"true\"></th><th></th></tr>"
      "</thead><tbody>\n";
  for (const Moves::Row& r : moves.rows) {
    const bool known = std::isfinite(r.sigmas);
    const double length = known ? 50 * std::min(1.0, std::abs(r.sigmas) / full) : 0;
    body_ += fmt::format(
        "<tr>{}<td class=\"r\" data-value=\"{}\">{}</td><td class=\"r\" data-value=\"{}\">{}</td>"
        "<td class=\"r\" data-value=\"{}\">{}</td><td class=\"short\" data-value=\"{}\">{}</td><td class=\"r\" "
        "data-value=\"{}\">{}</td>",
        cell_html(r.name, 'l', "th"), exact(r.exact_from), escape_html(r.from), exact(r.exact_to), escape_html(r.to),
        exact(r.exact_error), escape_html(r.error), escape_html(r.exact_unit), escape_html(r.unit), exact(r.sigmas),
        known ? (r.sigmas > 0 ? "+" : "") + digits(r.sigmas, 2) : "");
    body_ += fmt::format(
        "<td class=\"bar two\" aria-hidden=\"true\"><span class=\"fill{}\" style=\"{}:50%;width:{:.2f}%\"></span></td>"
        "<td class=\"note\">{}</td></tr>\n",
        known && std::abs(r.sigmas) > 3 ? " far" : "", r.sigmas < 0 ? "right" : "left", length, escape_html(r.note));
  }
  body_ += "</tbody></table></div></figure>\n";
}

void Page::add(const Tornado& tornado) {
  double full = 0;
  for (const Tornado::Row& r : tornado.rows)
    for (const double v : r.value)
      if (std::isfinite(v)) full = std::max(full, std::log1p(v));
  body_ += fmt::format(
      "<figure class=\"moves\"{}><figcaption><span>{}</span>{}</figcaption><div class=\"wide\"><table>",
      folded_rows(tornado.rows.size(), tornado.shown), escape_html(tornado.title), csv_button(tornado.title));
  body_ += fmt::format(
      "<thead><tr><th>{}</th><th class=\"r\">at minimum, {}</th><th class=\"bar\" aria-hidden=\"true\"></th>"
      "<th>at maximum</th><th></th></tr></thead><tbody>\n",
      escape_html(tornado.label), escape_html(tornado.unit));
  for (const Tornado::Row& r : tornado.rows) {
    body_ += fmt::format("<tr>{}<td class=\"r\" data-value=\"{}\">{}</td><td class=\"bar two\" aria-hidden=\"true\">",
                         cell_html(r.name, 'l', "th"), exact(r.value[0]), escape_html(r.text[0]));
    for (const std::size_t end : {0, 1})
      if (full > 0 && std::isfinite(r.value[end]))
        body_ += fmt::format("<span class=\"fill\" style=\"{}:50%;width:{:.2f}%\"></span>", end == 0 ? "right" : "left",
                             50 * std::log1p(r.value[end]) / full);
    body_ += fmt::format("</td><td data-value=\"{}\">{}</td><td class=\"note\">{}</td></tr>\n", exact(r.value[1]),
                         escape_html(r.text[1]), escape_html(r.note));
  }
  body_ += "</tbody></table></div></figure>\n";
}

void Page::add(const Matrix& m) {
  double full = 0;
  for (const auto& row : m.value)
    for (const double v : row)
      if (std::isfinite(v)) full = std::max(full, std::abs(v));
  body_ += fmt::format("<figure class=\"matrix\"><figcaption><span>{}</span>{}</figcaption><div class=\"wide\"><table>",
                       escape_html(m.title), csv_button(m.title));
  body_ += fmt::format("<thead><tr><th>{} \\ {}</th>", escape_html(m.row_label), escape_html(m.column_label));
  for (const std::string& c : m.columns) body_ += fmt::format("<th class=\"r\">{}</th>", escape_html(c));
  body_ += "</tr></thead><tbody>\n";
  for (std::size_t r = 0; r < m.rows.size(); ++r) {
    body_ += "<tr>" + cell_html(m.rows[r], 'l', "th");
    for (std::size_t c = 0; c < m.columns.size(); ++c) {
      const double v = m.value[r][c];
      const int depth = full > 0 && std::isfinite(v) ? static_cast<int>(std::lround(100 * std::abs(v) / full)) : 0;
      const bool right = m.diagonal_is_right && m.rows[r] == m.columns[c];
      body_ += fmt::format("<td class=\"r\" data-value=\"{}\" data-tone=\"{}\" style=\"--depth:{}%\">{}</td>", exact(v),
                           m.diagonal_is_right ? (right ? "good" : "bad") : "plain", depth,
                           std::isfinite(v) && !(m.diagonal_is_right && v == 0) ? digits(v) : "");
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div></figure>\n";
}

void Page::head(const std::string& name, const std::string& value) { header_.head.say(name, value); }

std::string Page::head_html() const {
  const PageHead& head = header_.head;
  std::string html = "<header>\n";
  if (!head.logo.empty() || !head.lines.empty()) {
    html += "<div class=\"house\">";
    if (!head.logo.empty()) html += fmt::format("<img src=\"{}\" alt=\"\">", escape_html(head.logo));
    html += "<p>";
    for (const std::string& line : head.lines) html += escape_html(line) + "<br>";
    html += "</p></div>\n";
  }
  html += fmt::format("<p><span class=\"tool\">servodx {}</span> <span class=\"title\">{}</span></p>\n",
                      escape_html(header_.command), escape_html(title_));
  if (!head.facts.empty()) {
    html += "<dl class=\"head\">";
    for (const auto& [name, value] : head.facts)
      html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", escape_html(name), escape_html(value));
    html += "</dl>\n";
  }
  return html + "</header>\n";
}

std::string Page::html() {
  section("How this was made", "", true);
  std::string settings;
  for (const auto& [key, value] : header_.settings->items())
    settings +=
        (settings.empty() ? "" : ", ") + key + " = " + value.dump(-1, ' ', false, Json::error_handler_t::replace);
  text(fmt::format("servodx {} {}, seed {}{}; {} simulations, {} of them failed.", header_.version, header_.command,
                   header_.seed, settings.empty() ? "" : ", " + settings, header_.simulations,
                   header_.failed_simulations));
  TablePart inputs{"Inputs", "ll", {"file", "SHA-256"}, {}, 0};
  for (const InputFile& file : header_.inputs) inputs.rows.push_back({file.path, file.sha256});
  if (!inputs.rows.empty()) add(inputs);
  if (!header_.notes.empty()) {
    body_ += "<h3>Notes</h3><ul class=\"notes\">";
    for (const std::string& note : header_.notes) body_ += fmt::format("<li>{}</li>", escape_html(note));
    body_ += "</ul>\n";
  }
  end_section();

  const auto allowed = [](std::string_view script) { return fmt::format("'sha256-{}'", sha256_base64(script)); };
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += fmt::format(
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src {} {}; img-src data:; base-uri 'none'; form-action 'none'\">\n",
      allowed(assets::chart_script), allowed(assets::page_script));
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  page += "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n";
  page += fmt::format("<title>{}</title>\n<style>{}\n{}</style>\n</head>\n<body>\n", escape_html(title_),
                      assets::chart_style, assets::page_style);
  page += head_html() + "<main>\n";
  page += body_;
  page += "</main>\n<noscript><p>The charts need JavaScript; words and tables do not.</p></noscript>\n";
  page += fmt::format("<script type=\"application/json\" id=\"data\">[{}]</script>\n", data_);
  page += fmt::format("<script>{}</script>\n<script>{}</script>\n</body>\n</html>\n", assets::chart_script,
                      assets::page_script);
  return page;
}

}  // namespace servodx::report
