/// @file Manual.cc
/// Walks the option table, and lays it out as help, troff and scripts.
#include "Manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

namespace {

/// What --help lists.
constexpr const char* kMostUsed[] = {"name",     "isovalue", "spacing", "voxels",   "grade",
                                     "optimize", "surface",  "sample",  "frames",   "dry-run",
                                     "report",   "threads",  "quiet",   "help-all", "version"};

struct Example {
    const char *command, *meaning;
};

constexpr Example kExamples[] = {
    {"vdb_tet bunny.vdb bunny.vtu", "the only scalar grid, or the only level set"},
    {"vdb_tet smoke.vdb smoke.vtu -n density -i 0.1", "where density is above 0.1"},
    {"vdb_tet bunny.vdb bunny.vtu --grade --optimize", "fewer tets inside, better ones outside"},
    {"vdb_tet bunny.obj bunny.msh --voxel-size 0.5", "a closed surface: .obj, .ply, .stl"},
    {"vdb_tet f.%04d.vdb 'f.{frame}.vtu' --frames 1-240", "a sequence"},
    {"vdb_tet info bunny.vdb", "what is in it, how many tets it makes"},
};

struct ExitCode {
    const char *code, *meaning;
};

constexpr ExitCode kExitCodes[] = {
    {"0", "all meshes are written"},
    {"1", "one could not be; standard error says why"},
    {"2", "the command line makes no sense"},
    {"128+N", "interrupted by signal N, 130 by Ctrl-C"},
};

struct Entry {
    std::string shortName, longName; ///< without dashes, maybe empty
    std::string value;               ///< such as LENGTH or y|z; empty for a flag
    bool optional = false;           ///< may the value be left out
    std::string text;                ///< the whole description
    std::string group;

    bool isFile() const { return value.find("FILE") != std::string::npos; }
    /// The values to choose from, if it has such.
    std::vector<std::string> choices() const {
        std::vector<std::string> all;
        if (value.find('|') == std::string::npos) return all;
        for (std::size_t at = 0; at <= value.size();) {
            const std::size_t end = std::min(value.find('|', at), value.size());
            all.push_back(value.substr(at, end - at));
            at = end + 1;
        }
        return all;
    }
    /// The first clause, for a line.
    std::string line() const {
        return text.substr(
            0, std::min({text.find(". "), text.find("; "), text.find(": "), text.find(", "), text.size()}));
    }
    /// Such as "-s, --spacing LENGTH".
    std::string synopsis() const {
        std::string names;
        if (!shortName.empty()) names = "-" + shortName;
        if (!longName.empty()) names += (names.empty() ? "--" : ", --") + longName;
        return value.empty() ? names : names + " " + value;
    }
};

std::vector<Entry> entriesOf(const CLI::App& app) {
    std::vector<Entry> entries;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional() || option->get_group().empty()) continue; // hidden
        Entry entry;
        if (!option->get_snames().empty()) entry.shortName = option->get_snames()[0];
        if (!option->get_lnames().empty()) entry.longName = option->get_lnames()[0];
        if (option->get_type_size() > 0) {
            entry.value = option->get_type_name();
            entry.optional = entry.value[0] == '[';
        }
        entry.text = option->get_description();
        entry.group = option->get_group();
        entries.push_back(entry);
    }
    return entries;
}

/// Groups in the order in which they appear.
std::vector<std::string> groupsOf(const std::vector<Entry>& entries) {
    std::vector<std::string> groups;
    for (const Entry& entry : entries) {
        if (std::find(groups.begin(), groups.end(), entry.group) == groups.end())
            groups.push_back(entry.group);
    }
    return groups;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

/// A text that troff takes for nothing but a text.
std::string troff(std::string text) {
    text = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    return !text.empty() && (text[0] == '.' || text[0] == '\'') ? "\\&" + text : text;
}

std::string bash(const std::vector<Entry>& entries) {
    std::string names, values, files;
    for (const Entry& entry : entries) {
        if (entry.longName.empty()) continue;
        names += (names.empty() ? "--" : " --") + entry.longName;
        if (!entry.choices().empty()) {
            values += fmt::format("    --{}) COMPREPLY=($(compgen -W '{}' -- \"$word\")) && return ;;\n",
                                  entry.longName, fmt::join(entry.choices(), " "));
        } else if (entry.isFile()) {
            files += (files.empty() ? "--" : "|--") + entry.longName;
        }
    }
    return fmt::format(R"(# bash completion for vdb_tet
_vdb_tet() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
    COMPREPLY=()
    case $previous in
{}    {}) COMPREPLY=($(compgen -f -- "$word")) && return ;;
    esac
    if [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W '{}' -- "$word"))
    else
        COMPREPLY=($(compgen -f -- "$word"))
        [[ $COMP_CWORD == 1 ]] && COMPREPLY+=($(compgen -W info -- "$word"))
    fi
}}
complete -o filenames -F _vdb_tet vdb_tet
)",
                       values, files, names);
}

/// Inside '...' of zsh's and fish's shells, and zsh's [...].
std::string quotedForShell(const std::string& text) {
    return replaced(replaced(replaced(replaced(text, "'", ""), "[", "("), "]", ")"), ":", "");
}

std::string zsh(const std::vector<Entry>& entries) {
    std::string script = "#compdef vdb_tet\n_arguments -s \\\n";
    for (const Entry& entry : entries) {
        std::string action;
        if (!entry.choices().empty()) {
            action = fmt::format(":value:({})", fmt::join(entry.choices(), " "));
        } else if (entry.isFile()) {
            action = ":file:_files";
        } else if (!entry.value.empty()) {
            action = ":" + quotedForShell(entry.value) + ":";
        }
        if (entry.optional) action = ":" + action;
        for (const std::string& name : {entry.shortName.empty() ? "" : "-" + entry.shortName,
                                        entry.longName.empty() ? "" : "--" + entry.longName}) {
            if (!name.empty())
                script += fmt::format("    '{}[{}]{}' \\\n", name, quotedForShell(entry.line()), action);
        }
    }
    return script + "    '*:file:_files'\n";
}

std::string fish(const std::vector<Entry>& entries) {
    std::string script = "# fish completion for vdb_tet\n";
    for (const Entry& entry : entries) {
        script += "complete -c vdb_tet";
        if (!entry.shortName.empty()) script += " -s " + entry.shortName;
        if (!entry.longName.empty()) script += " -l " + entry.longName;
        if (!entry.choices().empty()) {
            script += fmt::format(" -x -a '{}'", fmt::join(entry.choices(), " "));
        } else if (entry.isFile()) {
            script += " -r";
        } else if (!entry.value.empty() && !entry.optional) {
            script += " -x";
        }
        script += fmt::format(" -d '{}'\n", quotedForShell(entry.line()));
    }
    return script;
}

} // namespace

std::string helpScreen(const CLI::App& app) {
    const std::vector<Entry> entries = entriesOf(app);
    std::string text = app.get_description() + "\nUsage: vdb_tet [OPTIONS] IN... OUT\n\nExamples:\n";
    for (const Example& example : kExamples) text += fmt::format("  {}\n", example.command);
    text += "\nOptions used most:\n";
    for (const char* name : kMostUsed) {
        const auto entry =
            std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.longName == name; });
        if (entry == entries.end()) continue;
        text += fmt::format("  {:<30} {}\n", entry->synopsis(), entry->line());
    }
    return text + "\n--help-all tells all options, and each in full.\n";
}

std::string manPage(const CLI::App& app) {
    const std::vector<Entry> entries = entriesOf(app);
    std::string page = ".TH VDB_TET 1 \"\" \"vdbtet " VDBTET_VERSION "\" \"User Commands\"\n"
                       ".SH NAME\nvdb_tet \\- fill OpenVDB volumes with tetrahedra of guaranteed quality\n"
                       ".SH SYNOPSIS\n.B vdb_tet\n[\\fIOPTIONS\\fR] \\fIIN\\fR... \\fIOUT\\fR\n.br\n"
                       ".B vdb_tet info\n\\fIIN\\fR...\n.SH DESCRIPTION\n";
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) page += troff(option->get_description()) + ".\n";
    }
    page += "The extension of \\fIOUT\\fR tells the format. The old file stays until the new one is whole.\n";
    for (const std::string& group : groupsOf(entries)) {
        std::string title = group;
        for (char& c : title) c = char(std::toupper(static_cast<unsigned char>(c)));
        page += ".SH " + title + "\n";
        for (const Entry& entry : entries) {
            if (entry.group != group) continue;
            page += fmt::format(".TP\n.B {}\n{}.\n", troff(entry.synopsis()), troff(entry.text));
        }
    }
    page += ".SH EXAMPLES\n";
    for (const Example& example : kExamples)
        page += fmt::format(".TP\n.B {}\n{}\n", troff(example.command), troff(example.meaning));
    page += ".SH EXIT STATUS\n";
    for (const ExitCode& exitCode : kExitCodes)
        page += fmt::format(".TP\n.B {}\n{}\n", exitCode.code, troff(exitCode.meaning));
    return page;
}

std::string completion(const CLI::App& app, const std::string& shell) {
    const std::vector<Entry> entries = entriesOf(app);
    return shell == "bash" ? bash(entries) : shell == "zsh" ? zsh(entries) : fish(entries);
}
