#include "tungsten/app/Manual.h"

#include <CLI/CLI.hpp>

#include <sstream>

namespace tungsten {

namespace {

/// Text that roff takes as it stands.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n'))
            escaped += std::string("\\&") + c;
        else
            escaped += c;
    }
    return escaped;
}

/// "-t, --threads", and what follows it.
std::string namesOf(const CLI::Option& option) {
    std::string names;
    for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
    for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
    return names;
}
bool takesValue(const CLI::Option& option) {
    return option.get_items_expected_max() > 0 && option.get_type_size_max() > 0;
}

void writeOptions(std::ostream& out, const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        out << ".TP\n";
        if (option->get_positional())
            out << "\\fI" << roff(option->get_name()) << "\\fR\n";
        else
            out << "\\fB" << roff(namesOf(*option)) << "\\fR" << (takesValue(*option) ? " \\fIVALUE\\fR" : "") << "\n";
        out << roff(option->get_description()) << "\n";
    }
}

std::string wordsOf(const CLI::App& app) {
    std::string words;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_snames()) words += "-" + name + " ";
        for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
    }
    return words;
}

} // namespace

std::string manualPage(const CLI::App& app, const CLI::App& merge, const std::string& version) {
    std::ostringstream out;
    out << ".TH TUNGSTEN 1 \"\" \"" << roff(version) << "\"\n.SH NAME\ntungsten \\- time\\-of\\-flight renderer\n"
        << ".SH SYNOPSIS\n.B tungsten\n[\\fIOPTIONS\\fR] \\fISCENE\\fR...\n.br\n.B tungsten merge\n[\\fIOPTIONS\\fR] "
        << "\\fISTATE\\fR...\n.SH DESCRIPTION\n"
        << roff(app.get_description()) << "\n.SH OPTIONS\n";
    writeOptions(out, app);
    out << ".SH MERGE\n" << roff(merge.get_description()) << "\n";
    writeOptions(out, merge);
    return out.str();
}

std::string bashCompletion(const CLI::App& app, const CLI::App& merge) {
    return R"(# bash completion of tungsten; printed by tungsten --completion
_tungsten() {
    local word=${COMP_WORDS[COMP_CWORD]} files='json' options=')" +
           wordsOf(app) + R"('
    if [ "${COMP_WORDS[1]}" = merge ] && [ "$COMP_CWORD" -gt 1 ]; then
        files='state' options=')" +
           wordsOf(merge) + R"('
    elif [ "$COMP_CWORD" -eq 1 ]; then
        options+=merge
    fi
    case $word in
        -*) mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word") ;;
        *) mapfile -t COMPREPLY < <(compgen -f -X "!*.$files" -- "$word"; compgen -d -- "$word"
                                    [ "$COMP_CWORD" -gt 1 ] || compgen -W merge -- "$word") ;;
    esac
}
complete -o filenames -o bashdefault -F _tungsten tungsten
)";
}

} // namespace tungsten
