#include "tungsten/app/Describe.h"

#include <algorithm>
#include <map>
#include <ostream>

namespace tungsten {

namespace {

std::string quoted(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
    return text;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// Lines of text broken before `width` columns, each after `indent`.
std::string wrapped(const std::string& text, const std::string& indent) {
    constexpr size_t Width = 100;
    std::string lines;
    for (size_t start = 0; start < text.size();) {
        size_t end = text.size();
        if (end - start > Width - indent.size()) {
            const size_t space = text.rfind(' ', start + Width - indent.size());
            if (space != std::string::npos && space > start) end = space;
        }
        lines += indent + text.substr(start, end - start) + "\n";
        start = end < text.size() ? end + 1 : end;
    }
    return lines;
}

std::string title(const std::string& kind) {
    return kind == "bsdfs" ? "BSDFs" : char(std::toupper(kind[0])) + kind.substr(1);
}

std::string cell(std::string text) {
    for (size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.replace(at, 1, "\\|");
    return text;
}

/// Fields that the same types of a kind declare alike.
struct SharedFields {
    std::vector<std::string> types;
    std::vector<Field> fields;
};

std::vector<SharedFields> shareFields(const DescribedKind& kind) {
    std::vector<std::pair<Field, std::vector<std::string>>> rows;
    for (const auto& type : kind.types)
        for (const Field& field : type->fields) {
            const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.first == field; });
            if (row == rows.end())
                rows.push_back({field, {type->name}});
            else
                row->second.push_back(type->name);
        }
    std::vector<SharedFields> tables;
    for (const auto& row : rows) {
        const auto table =
            std::find_if(tables.begin(), tables.end(), [&](const SharedFields& t) { return t.types == row.second; });
        if (table == tables.end())
            tables.push_back({row.second, {row.first}});
        else
            table->fields.push_back(row.first);
    }
    std::stable_sort(tables.begin(), tables.end(),
                     [](const SharedFields& a, const SharedFields& b) { return a.types.size() > b.types.size(); });
    return tables;
}

void printTable(const std::vector<Field>& fields, std::ostream& out) {
    out << "\n| field | default | accepted, in its unit | meaning |\n| --- | --- | --- | --- |\n";
    for (const Field& field : fields)
        out << "| `" << field.name << "` | " << cell(field.fallback) << " | " << cell(field.accepted)
            << (field.unit == "none" ? "" : " [" + field.unit + "]") << " | " << cell(field.meaning) << " |\n";
}

void printBlocks(const DescribedKind& kind, std::ostream& out) {
    for (size_t i = 0; i < kind.types.size(); ++i) {
        const Description& block = *kind.types[i];
        out << "\n### " << block.name << '\n';
        const auto end = kind.types.begin() + std::ptrdiff_t(i);
        const auto alike =
            std::find_if(kind.types.begin(), end, [&](const auto& earlier) { return earlier->fields == block.fields; });
        if (alike == end)
            printTable(block.fields, out);
        else
            out << "\nThe fields of `" << (*alike)->name << "`.\n";
        const std::vector<std::string> ignored = block.ignored();
        if (!ignored.empty()) out << "\nAccepted without effect: " << quoted(ignored) << ".\n";
    }
}

/// Types that ignore the same fields in one sentence.
void printIgnored(const DescribedKind& kind, std::ostream& out) {
    std::map<std::vector<std::string>, std::vector<std::string>> typesByFields;
    for (const auto& type : kind.types) typesByFields[type->ignored()].push_back(type->name);
    for (const auto& [fields, types] : typesByFields)
        if (!fields.empty()) out << "\nAccepted without effect by " << quoted(types) << ": " << quoted(fields) << ".\n";
}

void printKind(const DescribedKind& kind, std::ostream& out) {
    std::vector<std::string> types;
    for (const auto& type : kind.types) types.push_back(type->name);
    const Description& first = *kind.types.front();
    if (first.note.empty() || first.fields.empty()) {
        out << '\n' << quoted(types) << "\n\n" << first.note << (first.note.empty() ? "" : "\n");
    } else {
        out << '\n';
        for (const auto& type : kind.types) out << "- `" << type->name << "`: " << type->note << '\n';
    }
    for (const SharedFields& shared : shareFields(kind)) {
        out << "\n### " << (shared.types == types ? "All of them" : quoted(shared.types)) << '\n';
        printTable(shared.fields, out);
    }
    printIgnored(kind, out);
}

void printType(const Description& type, const std::string& kind, std::ostream& out) {
    out << type.name << " (" << kind << ")\n" << wrapped(type.note, "  ");
    for (const Field& field : type.fields) {
        const std::string unit = field.unit == "none" ? "" : " [" + field.unit + "]";
        out << "  " << field.name << unit << ", default " << field.fallback << '\n'
            << wrapped(field.meaning, "      ") << wrapped("accepts " + field.accepted, "      ");
    }
    const std::vector<std::string> ignored = type.ignored();
    if (!ignored.empty()) out << wrapped("accepted without effect: " + joined(ignored), "  ");
}

} // namespace

void printDescriptions(const std::vector<DescribedKind>& kinds, std::ostream& out) {
    for (const DescribedKind& kind : kinds)
        for (const auto& type : kind.types) printType(*type, kind.kind, out);
}

void printMarkdown(const std::vector<DescribedKind>& kinds, std::ostream& out) {
    out << "# Scene fields\n\nEvery field that is read from a scene, as `tungsten --describe` shows it too. This page "
           "is "
           "generated:\n`scripts/scene-fields.sh` writes it anew from the declarations in the code.\n\n"
           "Lengths are in the scene's unit; in a unit of time light travels `speed_of_light` of them.\n"
           "Colours are linear; where a number stands for three, it counts for each.\n";
    for (const DescribedKind& kind : kinds) {
        if (kind.types.empty()) continue; // integrators, where no plugin is found
        out << "\n## " << title(kind.kind) << '\n';
        if (kind.kind == "blocks")
            printBlocks(kind, out);
        else
            printKind(kind, out);
    }
}

} // namespace tungsten
