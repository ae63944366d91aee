// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "onboard/report/page/html_text.hpp"
#include "tools/protocol/report/tables.hpp"

namespace cairn::protocol {
namespace {

/// Characters, not bytes: ° and – take more than one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string space(width - std::min(width, width_of(text)), ' ');
  return left ? text + space : space + text;
}

}  // namespace

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& h : table.header) widths.push_back(width_of(h));
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : "  ") + padded(cells[i], widths[i], i == 0);
    return text + '\n';
  };
  std::string text = table.title + '\n' + line(table.header);
  for (const auto& row : table.rows) text += line(row);
  return text + '\n';
}

std::string to_html(const Table& table) {
  std::string html =
      fmt::format("<section><h2>{}</h2><div class=\"scroll\"><table><tr>", report::html::escape(table.title));
  for (std::size_t i = 0; i < table.header.size(); ++i)
    html += fmt::format("<th{}>{}</th>", i == 0 ? " class=\"l\"" : "", report::html::escape(table.header[i]));
  html += "</tr>";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      html += fmt::format("<td{}>{}</td>", i == 0 ? " class=\"l\"" : "", report::html::escape(row[i]));
    html += "</tr>";
  }
  html += "</table></div>";
  if (!table.note.empty()) html += fmt::format("<p class=\"note\">{}</p>", report::html::escape(table.note));
  return html + "</section>";
}

}  // namespace cairn::protocol
