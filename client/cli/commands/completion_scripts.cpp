#include "cli/commands/completion_scripts.hpp"

namespace meniscus::cli {
namespace {

void append(std::string& words, const std::string& word) {
    if (!words.empty()) words += ' ';
    words += word;
}

std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) append(all, word);
    return all;
}

/// One word of a shell, whatever is in it.
std::string shell_word(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string option_names(const CompletedCommand& command) {
    std::string all;
    for (const CompletedOption& option : command.options) append(all, joined(option.names));
    return all;
}

/// The explanation of an option for zsh, which ends at a bracket.
std::string zsh_explanation(const std::string& text) {
    std::string out = "[";
    for (const char c : text) {
        if (c == '[' || c == ']' || c == '\\') out += '\\';
        out += c;
    }
    return out + "]";
}

std::string zsh_action(const std::vector<std::string>& choices) {
    return choices.empty() ? "_files" : "(" + joined(choices) + ")";
}

/// An argument of zsh's _arguments: '(-o --output)'{-o,--output}'[What it is]:value:_files'
std::string zsh_option(const CompletedOption& option) {
    std::string values;
    for (std::size_t i = 0; i < option.values; ++i) values += ":value:" + zsh_action(option.choices);
    const std::string rest = zsh_explanation(option.description) + values;
    if (option.names.size() == 1) return shell_word(option.names.front() + rest);
    std::string braces;
    for (const std::string& name : option.names) braces += (braces.empty() ? "{" : ",") + name;
    return shell_word("(" + joined(option.names) + ")") + braces + "}" + shell_word(rest);
}

}  // namespace

std::string bash_completion(const CompletedCommand& program, const std::vector<CompletedCommand>& commands) {
    std::string names = option_names(program);
    std::string values, options, arguments;
    for (const CompletedCommand& command : commands) {
        append(names, command.name);
        options += "            " + command.name + ") words='" + option_names(command) + "' ;;\n";
        for (const CompletedOption& option : command.options)
            for (const std::string& name : option.names)
                if (!option.choices.empty())
                    values +=
                        "        '" + command.name + " " + name + "') words='" + joined(option.choices) + "' ;;\n";
        for (const CompletedOption& argument : command.arguments)
            if (!argument.choices.empty())
                arguments += "            " + command.name + ") words='" + joined(argument.choices) + "' ;;\n";
    }
    const std::string function = "_" + program.name;
    return "# Completion of " + program.name + " for bash, written by: " + program.name + " completion bash\n" +
           function +
           "() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words=\n"
           "    COMPREPLY=()\n"
           "    case \"$command ${COMP_WORDS[COMP_CWORD - 1]}\" in\n" +
           values +
           "    esac\n"
           "    if ((COMP_CWORD == 1)); then\n"
           "        words='" +
           names +
           "'\n"
           "    elif [[ -z $words && $word == -* ]]; then\n"
           "        case $command in\n" +
           options +
           "        esac\n"
           "    elif [[ -z $words ]]; then\n"
           "        case $command in\n" +
           arguments +
           "        esac\n"
           "    fi\n"
           "    # Without words the shell offers files.\n"
           "    [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
           "}\n"
           "complete -o default -F " +
           function + " " + program.name + "\n";
}

std::string zsh_completion(const CompletedCommand& program, const std::vector<CompletedCommand>& commands) {
    std::string list, cases;
    for (const CompletedCommand& command : commands) {
        list += "        " + shell_word(command.name + ":" + command.description) + "\n";
        cases += "        " + command.name + ")\n            _arguments";
        for (const CompletedOption& option : command.options) cases += " \\\n                " + zsh_option(option);
        for (const CompletedOption& argument : command.arguments)
            cases += " \\\n                " + shell_word(":argument:" + zsh_action(argument.choices));
        cases += "\n            ;;\n";
    }
    std::string options;
    for (const CompletedOption& option : program.options) options += " " + zsh_option(option);
    return "#compdef " + program.name + "\n# Completion of " + program.name + " for zsh, written by: " + program.name +
           " completion zsh\n_" + program.name +
           "() {\n"
           "    local -a commands=(\n" +
           list +
           "    )\n"
           "    if ((CURRENT == 2)); then\n"
           "        _arguments" +
           options +
           "\n"
           "        _describe command commands\n"
           "        return\n"
           "    fi\n"
           "    local command=$words[2]\n"
           "    shift words\n"
           "    ((CURRENT--))\n"
           "    case $command in\n" +
           cases +
           "    esac\n"
           "}\n_" +
           program.name + " \"$@\"\n";
}

}  // namespace meniscus::cli
