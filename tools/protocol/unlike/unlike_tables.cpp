// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/unlike_tables.hpp"

#include <fmt/format.h>

#include <functional>

#include "hal/semantic_class.hpp"
#include "tools/protocol/report/figures.hpp"
#include "tools/protocol/unlike/label_tables.hpp"

namespace cairn::protocol {
namespace {

constexpr std::array kPhaseNames{"beginning", "middle", "final"};

using Part = EntropiesOfThree FusedEntropies::*;

std::string decimals(double value) { return fmt::format("{:.4f}", value); }

std::array<std::string, 3> each(const EntropiesOfThree& e, const std::function<double(const Entropies&)>& value) {
  return {decimals(value(e.a)), decimals(value(e.b)), decimals(value(e.fused))};
}

void append(std::vector<std::string>& row, const std::array<std::string, 3>& cells) {
  row.insert(row.end(), cells.begin(), cells.end());
}

std::array<std::string, 3> counts(const EntropiesOfThree& e, std::uint64_t Entropies::*voxels) {
  return {fmt::format("{}", e.a.*voxels), fmt::format("{}", e.b.*voxels), fmt::format("{}", e.fused.*voxels)};
}

/// Three rows for each scene: the binary entropy with labels and both, the book's form of occupancy, and over how many
/// voxels the means are.
Table entropies_table(const std::vector<UnlikeOutcome>& all, std::string title, std::string note, Part part) {
  Table table{std::move(title),
              std::move(note),
              {"", "occupancy UGV", "UAV", "fused", "label UGV", "UAV", "fused", "overall UGV", "UAV", "fused"},
              {}};
  for (const UnlikeOutcome& o : all) {
    if (!o.entropies) continue;
    const EntropiesOfThree& e = *o.entropies.*part;
    std::vector<std::string> row{o.scene()}, book_form{o.scene() + ", −p log2 p"}, voxels{o.scene() + ", voxels"};
    if (e.fused.occupied > 0) append(row, each(e, [](const Entropies& x) { return x.occupancy; }));
    if (e.fused.labelled > 0) append(row, each(e, [](const Entropies& x) { return x.label; }));
    if (e.fused.labelled > 0) append(row, each(e, [](const Entropies& x) { return x.overall(); }));
    if (e.fused.occupied > 0) append(book_form, each(e, [](const Entropies& x) { return x.book; }));
    append(voxels, counts(e, &Entropies::occupied));
    append(voxels, counts(e, &Entropies::labelled));
    for (auto* added : {&row, &book_form, &voxels}) {
      added->resize(table.header.size(), "–");
      table.rows.push_back(std::move(*added));
    }
  }
  return table;
}

std::string class_name(unsigned id) { return std::string(kSemanticClasses.at(id).name); }

}  // namespace

std::array<const UnlikeOutcome*, 3> three_times(const std::vector<const UnlikeOutcome*>& fusions) {
  if (fusions.empty()) return {};
  return {fusions.front(), fusions[(fusions.size() - 1) / 2], fusions.back()};
}

Table fused_table(const std::vector<UnlikeOutcome>& all) {
  Table table = entropies_table(
      all, "Mean entropy of each robot's map and of the fused one (book: Table 7.5)",
      "At the end of the mission. Each of the UAV's voxels goes to the nearest of the UGV's, by (7.15), within a "
      "voxel's diagonal. Occupancy: binary, bit, over occupied voxels, fused by (7.19). Label: over 19 "
      "classes, as a part of log2(19), over labelled voxels, fused by (7.20). Overall: the mean over all these values. "
      "The book leaves out the form of its entropy and how it makes its overall value. Its numbers are from other "
      "places. The text at hand has lost the table's rows: they are read column by column here.",
      &FusedEntropies::whole);
  for (const BookFused& book : kBookFused) {
    std::vector<std::string> row{fmt::format("(book: {})", book.place)};
    for (const auto& values : {book.occupancy, book.label, book.overall})
      append(row, {decimals(values[0]), decimals(values[1]), decimals(values[2])});
    row.resize(table.header.size(), "–");
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table shared_table(const std::vector<UnlikeOutcome>& all) {
  return entropies_table(all, "The same over the voxels that have a partner",
                         "Labels: where both robots have one. Several of the UAV's voxels may go to one of the UGV's.",
                         &FusedEntropies::shared);
}

Table told_table(const std::vector<UnlikeOutcome>& all) {
  return entropies_table(
      all, "The same as a team fuses",
      "Robots exchange occupancy in six grades and the likeliest class in four. Occupancy is fused by "
      "relative entropy, labels by (7.20). A class is never surer than 0.95 then.",
      &FusedEntropies::told);
}

Table label_rows_table() {
  Table table{
      "Two labels of one voxel become one (book: Tables 7.3 and 7.4)",
      "By (7.20), normalised over the classes. The book prints one probability of 19 for each robot, and the "
      "fused one depends on how the rest is spread. Evenly: nothing is chosen. Share: of the rest, what one rival "
      "class must have so that the rule gives the book's number. In 7.3 it is robot 2's rest and robot 1's class, "
      "in 7.4 both robots' rest and one third class. Least by Bayes over all classes at once: below it that rule "
      "cannot come, and the book's numbers are below it.",
      {"table", "robot 1", "robot 2", "fused", "book", "rest spread evenly", "share", "with that share",
       "least by Bayes over all classes"},
      {}};
  for (const FusedLabelRow& row : fused_label_rows()) {
    const BookLabels& b = row.book;
    table.rows.push_back({std::string(b.table), fmt::format("{} {:.3f}", class_name(b.class_1), b.p_1),
                          fmt::format("{} {:.3f}", class_name(b.class_2), b.p_2), class_name(row.class_id),
                          fmt::format("{} {:.3f}", class_name(b.fused_class), b.fused_p),
                          fmt::format("{:.3f}", row.evenly),
                          row.share ? fmt::format("{:.1f} %", 100 * *row.share) : "none",
                          row.share ? fmt::format("{:.3f}", row.with_share) : "–",
                          row.least_categorical ? fmt::format("{:.3f}", *row.least_categorical) : "–"});
  }
  return table;
}

Table unlike_rms_table(const std::vector<UnlikeOutcome>& all) {
  Table table{
      "RMS of matched voxels of a UGV's and a UAV's map, m (book: Table 5.2)",
      "Voxels with a partner within 1 m, mean over the starts; –: no voxel has one. EM as printed: Algorithm 3. The "
      "book's numbers are of other robots and places.",
      {"", "seconds", "OICP", "EM as printed", "Cairn's EM", "default", "success OICP, %", "EM as printed",
       "Cairn's EM", "default"},
      {}};
  for (const std::string& scene : scenes_of(all)) {
    const auto times = three_times(fusions_of(all, scene));
    for (std::size_t i = 0; i < times.size(); ++i) {
      std::vector<std::string> row{fmt::format("{}, {}", scene, kPhaseNames.at(i)),
                                   fmt::format("{:.0f}", times.at(i)->moment.seconds)};
      std::vector<std::string> successes;
      for (const char* method : {"oicp", "em_book", "em", "default"}) {
        const MethodRun* run = times.at(i)->outcome.run(method);
        const Figures f = run != nullptr ? figures_of(run->attempts) : Figures{};
        row.push_back(f.rms_m > 0 ? decimals(f.rms_m) : "–");
        successes.push_back(run != nullptr ? fmt::format("{:.0f}", 100 * f.success) : "–");
      }
      row.insert(row.end(), successes.begin(), successes.end());
      table.rows.push_back(std::move(row));
    }
  }
  for (const BookRms& book : kBookRms) {
    std::vector<std::string> row{fmt::format("(book: {}, three times)", book.place), "–"};
    for (const auto& rms : {book.oicp, book.em})
      row.push_back(fmt::format("{:.4f}, {:.4f}, {:.4f}", rms[0], rms[1], rms[2]));
    row.resize(table.header.size(), "–");
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table fusions_table(const std::vector<UnlikeOutcome>& all) {
  Table table{
      "Each fusion of the mission (book: Figs. 5.13 and 5.14)",
      "Correspondences: of a voxel of the sparser map, by Cairn's EM. Seconds: CPU time of one thread for features, a "
      "match and merging. Off: the default method's pose from the true one; the truth is that of the first pose, "
      "so the drift of odometry is in it. Accepted: what the method itself says of it.",
      {"", "seconds of mission", "voxels UGV", "UAV", "overlap", "correspondences", "s with OICP", "EM as printed",
       "Cairn's EM", "default", "of it merging", "off, m", "°", "accepted"},
      {}};
  for (const UnlikeOutcome& o : all) {
    const MethodRun* em = o.outcome.run("em");
    const MapPair& p = o.outcome.pair;
    table.rows.push_back({fmt::format("{}, {}", o.scene(), o.moment.fusion), fmt::format("{:.0f}", o.moment.seconds),
                          fmt::format("{}", p.voxels_a), fmt::format("{}", p.voxels_b),
                          fmt::format("{:.2f}", p.overlap),
                          em != nullptr ? fmt::format("{:.2f}", em->correspondences.value_or(1)) : "–",
                          fmt::format("{:.2f}", o.seconds("oicp")), fmt::format("{:.2f}", o.seconds("em_book")),
                          fmt::format("{:.2f}", o.seconds("em")), fmt::format("{:.2f}", o.seconds("default")),
                          fmt::format("{:.3f}", o.merge_s), fmt::format("{:.3f}", o.attempt.error.m),
                          fmt::format("{:.2f}", o.attempt.error.deg), o.attempt.accepted ? "yes" : "no"});
  }
  return table;
}

std::vector<Table> unlike_tables(const std::vector<UnlikeOutcome>& all) {
  return {fused_table(all),   shared_table(all),     told_table(all),
          label_rows_table(), unlike_rms_table(all), fusions_table(all)};
}

}  // namespace cairn::protocol
