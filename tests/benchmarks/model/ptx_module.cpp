#include "model/ptx_module.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <iterator>
#include <map>
#include <stdexcept>

#include "model/ptx_codes.hpp"

namespace meniscus::benchmarks {
namespace {

using Words = std::vector<std::string>;

bool begins(std::string_view text, std::string_view with) {
    return text.substr(0, with.size()) == with;
}
bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

std::string trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\n\r");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t\n\r") - first + 1));
}

/// Operands are parted by commas outside of braces and brackets.
Words split_operands(std::string_view text) {
    Words out;
    std::string word;
    int depth = 0;
    for (const char c : text) {
        depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
        if (c == ',' && depth == 0) {
            out.push_back(trimmed(word));
            word.clear();
        } else {
            word += c;
        }
    }
    if (const std::string last = trimmed(word); !last.empty()) out.push_back(last);
    return out;
}

std::uint64_t parse_constant(const std::string& text) {
    const std::string_view digits = text;
    std::uint64_t bits = 0;
    if (begins(digits, "0f") || begins(digits, "0F") || begins(digits, "0d") || begins(digits, "0D")) {
        std::from_chars(text.data() + 2, text.data() + text.size(), bits, 16);
        return bits;
    }
    const bool is_negative = begins(digits, "-");
    std::size_t at = is_negative ? 1 : 0;
    const int base = begins(digits.substr(at), "0x") ? 16 : 10;
    if (base == 16) at += 2;
    const auto end = std::from_chars(text.data() + at, text.data() + text.size(), bits, base);
    if (end.ec != std::errc() || (*end.ptr != '\0' && *end.ptr != 'U')) throw std::runtime_error("no number: " + text);
    return is_negative ? ~bits + 1 : bits;
}

unsigned bits_of_type(std::string_view type) {
    return static_cast<unsigned>(std::stoul(std::string(type.substr(1))));
}

class KernelReader {
public:
    /// shared_at: where the module's shared variables lie.
    explicit KernelReader(std::string name) { kernel_.name = std::move(name); }

    void add_parameter(const std::string& name) { parameters_[name] = kernel_.parameters++; }
    void add_shared(const std::string& name, std::uint64_t bytes, std::uint64_t alignment) {
        const std::uint64_t at = (kernel_.shared_bytes + alignment - 1) / alignment * alignment;
        shared_[name] = at;
        kernel_.shared_bytes = at + bytes;
    }
    void add_label(const std::string& name) { labels_[name] = static_cast<std::int32_t>(kernel_.instructions.size()); }
    void add_statement(std::string text);
    PtxKernel finish();

private:
    std::int32_t slot(const std::string& operand);
    std::int32_t preset(PtxPreset::What what, std::uint64_t value, const std::string& name);
    /// [register+offset], [name+offset] or [register].
    void read_address(std::string text, PtxInstruction& to);
    void read_values(const std::string& text, std::int32_t* slots, PtxInstruction& of);
    void read_memory(const Words& operands, PtxInstruction& to);

    PtxKernel kernel_;
    std::map<std::string, std::uint32_t> parameters_;
    std::map<std::string, std::uint64_t> shared_;
    std::map<std::string, std::int32_t> slots_;
    std::map<std::string, std::int32_t> labels_;
    std::vector<std::pair<std::size_t, std::string>> branches_;
};

std::int32_t KernelReader::preset(PtxPreset::What what, std::uint64_t value, const std::string& name) {
    const std::int32_t at = kernel_.slots++;
    kernel_.presets.push_back({at, what, value});
    return slots_[name] = at;
}

std::int32_t KernelReader::slot(const std::string& operand) {
    if (const auto found = slots_.find(operand); found != slots_.end()) return found->second;
    using What = PtxPreset::What;
    static const std::map<std::string, What> specials = {
        {"%tid.x", What::thread},         {"%ctaid.x", What::block}, {"%ntid.x", What::threads},
        {"%nctaid.x", What::blocks},      {"%laneid", What::lane},   {"%envreg1", What::workspace_high},
        {"%envreg2", What::workspace_low}};
    if (const auto found = specials.find(operand); found != specials.end()) return preset(found->second, 0, operand);
    if (begins(operand, "%tid.") || begins(operand, "%ctaid.")) return preset(What::constant, 0, operand);
    if (begins(operand, "%ntid.") || begins(operand, "%nctaid.")) return preset(What::constant, 1, operand);
    if (operand.at(0) == '%') return slots_[operand] = kernel_.slots++;
    if (const auto found = parameters_.find(operand); found != parameters_.end())
        return preset(What::parameter_address, found->second, operand);
    if (const auto found = shared_.find(operand); found != shared_.end())
        return preset(What::constant, found->second, operand);
    return preset(What::constant, parse_constant(operand), operand);
}

void KernelReader::read_address(std::string text, PtxInstruction& to) {
    text = trimmed(std::string_view(text).substr(1, text.size() - 2));
    if (const auto plus = text.rfind('+'); plus != std::string::npos) {
        to.offset = static_cast<std::int64_t>(parse_constant(text.substr(plus + 1)));
        text.resize(plus);
    }
    to.from[0] = slot(text);
}

void KernelReader::read_values(const std::string& text, std::int32_t* slots, PtxInstruction& of) {
    if (text.at(0) != '{') {
        *slots = slot(text);
        return;
    }
    const Words parts = split_operands(std::string_view(text).substr(1, text.size() - 2));
    of.elements = static_cast<std::uint8_t>(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) slots[i] = slot(parts[i]);
}

void KernelReader::read_memory(const Words& operands, PtxInstruction& to) {
    const std::string& opcode = to.opcode;
    to.space = contains(opcode, ".shared")  ? PtxSpace::shared
               : contains(opcode, ".param") ? PtxSpace::parameter
                                            : PtxSpace::global;
    to.is_acquire = contains(opcode, ".acquire");
    const std::string type = opcode.substr(opcode.rfind('.') + 1);
    to.element_bytes = static_cast<std::uint8_t>(bits_of_type(type) / 8);
    to.is_signed = type[0] == 's';
    if (begins(opcode, "ld.")) {
        to.kind = PtxKind::load;
        read_values(operands.at(0), to.to, to);
        read_address(operands.at(1), to);
    } else if (begins(opcode, "st.")) {
        to.kind = PtxKind::store;
        read_address(operands.at(0), to);
        read_values(operands.at(1), to.from + 1, to);
    } else {
        to.kind = PtxKind::atomic;
        const bool answers = begins(opcode, "atom.");
        if (answers) to.to[0] = slot(operands.at(0));
        const std::size_t address = answers ? 1 : 0;
        read_address(operands.at(address), to);
        for (std::size_t i = address + 1; i < operands.size(); ++i) to.from[i - address] = slot(operands[i]);
        to.detail = static_cast<std::uint8_t>(contains(opcode, ".add")    ? PtxAtomic::add
                                              : contains(opcode, ".or")   ? PtxAtomic::bit_or
                                              : contains(opcode, ".and")  ? PtxAtomic::bit_and
                                              : contains(opcode, ".max")  ? PtxAtomic::max
                                              : contains(opcode, ".min")  ? PtxAtomic::min
                                              : contains(opcode, ".exch") ? PtxAtomic::exchange
                                              : contains(opcode, ".cas")  ? PtxAtomic::compare_and_swap
                                                                          : PtxAtomic::unknown);
        if (to.detail == static_cast<std::uint8_t>(PtxAtomic::unknown))
            throw std::runtime_error("the interpreter does not know " + opcode);
    }
}

void KernelReader::add_statement(std::string text) {
    PtxInstruction instruction;
    if (text[0] == '@') {
        const auto end = text.find_first_of(" \t");
        instruction.guard_is_negated = text[1] == '!';
        instruction.guard =
            slot(text.substr(instruction.guard_is_negated ? 2 : 1, end - (instruction.guard_is_negated ? 2 : 1)));
        text = trimmed(std::string_view(text).substr(end));
    }
    const auto end = text.find_first_of(" \t");
    const std::string opcode = text.substr(0, end);
    instruction.opcode = opcode;
    const Words operands =
        split_operands(end == std::string::npos ? std::string_view() : std::string_view(text).substr(end));
    const auto read_from = [&](std::size_t first) {
        for (std::size_t i = first; i < operands.size(); ++i) instruction.from[i - first] = slot(operands[i]);
    };
    if (begins(opcode, "bra")) {
        instruction.kind = PtxKind::branch;
        branches_.emplace_back(kernel_.instructions.size(), operands.at(0));
    } else if (opcode == "ret" || opcode == "exit") {
        instruction.kind = PtxKind::end;
    } else if (opcode == "trap") {
        instruction.kind = PtxKind::trap;
    } else if (begins(opcode, "bar.warp.sync")) {
        instruction.kind = PtxKind::warp_barrier;
        read_from(0);
    } else if (begins(opcode, "bar.sync") || begins(opcode, "barrier.sync")) {
        instruction.kind = PtxKind::block_barrier;
    } else if (begins(opcode, "membar") || begins(opcode, "fence")) {
        instruction.kind = PtxKind::nothing;
    } else if (begins(opcode, "shfl.sync")) {
        instruction.kind = PtxKind::shuffle;
        const std::string& destination = operands.at(0);
        const auto bar = destination.find('|');
        instruction.to[0] = slot(destination.substr(0, bar));
        if (bar != std::string::npos) instruction.to[1] = slot(destination.substr(bar + 1));
        read_from(1);
        instruction.detail = static_cast<std::uint8_t>(contains(opcode, ".idx")    ? PtxShuffle::index
                                                       : contains(opcode, ".up")   ? PtxShuffle::up
                                                       : contains(opcode, ".down") ? PtxShuffle::down
                                                                                   : PtxShuffle::exclusive_or);
    } else if (begins(opcode, "vote.sync.ballot")) {
        instruction.kind = PtxKind::ballot;
        instruction.to[0] = slot(operands.at(0));
        read_from(1);
    } else if (begins(opcode, "ld.") || begins(opcode, "st.") || begins(opcode, "atom.") || begins(opcode, "red.")) {
        read_memory(operands, instruction);
    } else {
        instruction.kind = PtxKind::compute;
        instruction.compute = find_computation(opcode);
        if (instruction.compute == nullptr) throw std::runtime_error("the interpreter does not know " + opcode);
        // mov.b64 {low, high} and back.
        if (begins(opcode, "mov.") && operands.at(0)[0] == '{') {
            read_values(operands[0], instruction.to, instruction);
            instruction.from[0] = slot(operands.at(1));
            instruction.compute = find_computation(opcode + ".unpack");
        } else if (begins(opcode, "mov.") && operands.at(1)[0] == '{') {
            instruction.to[0] = slot(operands[0]);
            read_values(operands[1], instruction.from, instruction);
            instruction.compute = find_computation(opcode + ".pack");
        } else {
            const auto bar = operands.at(0).find('|');
            instruction.to[0] = slot(operands[0].substr(0, bar));
            read_from(1);
        }
        if (instruction.compute == nullptr) throw std::runtime_error("the interpreter does not know " + text);
    }
    const auto count = [](const auto& used) {
        return static_cast<std::uint8_t>(
            std::count_if(std::begin(used), std::end(used), [](auto s) { return s >= 0; }));
    };
    instruction.to_count = count(instruction.to);
    instruction.from_count = count(instruction.from);
    kernel_.instructions.push_back(std::move(instruction));
}

PtxKernel KernelReader::finish() {
    for (const auto& [at, label] : branches_) {
        const std::int32_t target = labels_.at(label);
        kernel_.instructions[at].target = target;
        kernel_.instructions[static_cast<std::size_t>(target)].is_target = true;
    }
    return std::move(kernel_);
}

/// `.align 8 .b8 name[16]`, `.u32 name`: the name, and the bytes of an array.
struct Declared {
    std::string name;
    std::uint64_t bytes = 0;
    std::uint64_t alignment = 1;
};
Declared read_declaration(const std::string& text) {
    Declared out;
    const auto space = text.find_last_of(" \t");
    std::string name = text.substr(space + 1);
    std::uint64_t count = 1;
    if (const auto bracket = name.find('['); bracket != std::string::npos) {
        count = parse_constant(name.substr(bracket + 1, name.find(']') - bracket - 1));
        name.resize(bracket);
    }
    const auto type_end = text.find_last_not_of(" \t", space);
    const auto type_begin = text.rfind('.', type_end);
    const unsigned element = bits_of_type(std::string_view(text).substr(type_begin + 1, type_end - type_begin)) / 8;
    out.name = name;
    out.bytes = count * element;
    out.alignment = element;
    if (const auto align = text.find(".align "); align != std::string::npos)
        out.alignment = std::stoul(text.substr(align + 7));
    return out;
}

std::string without_comments(std::string_view text) {
    std::string out;
    std::size_t at = 0;
    while (at < text.size()) {
        const auto line_end = std::min(text.find('\n', at), text.size());
        std::string_view line = text.substr(at, line_end - at);
        line = line.substr(0, std::min(line.find("//"), line.size()));
        out += line;
        out += '\n';
        at = line_end + 1;
    }
    return out;
}

/// The statements between a kernel's braces.
void read_body(std::string_view body, KernelReader& reader) {
    std::size_t at = 0;
    while (at < body.size()) {
        const auto end = body.find_first_of(";:{}", at);
        if (end == std::string_view::npos) break;
        std::string statement = trimmed(body.substr(at, end - at));
        if (body[end] == ':') {
            reader.add_label(statement);
            at = end + 1;
            continue;
        }
        // Braces hold a vector within a statement, and a scope of inline assembly between statements.
        if (body[end] == '{' || body[end] == '}') {
            if (statement.empty()) {
                at = end + 1;
                continue;
            }
            const auto semicolon = body.find(';', end);
            statement = trimmed(body.substr(at, semicolon - at));
            at = semicolon + 1;
        } else {
            at = end + 1;
        }
        if (statement.empty() || begins(statement, ".reg") || begins(statement, ".pragma") || begins(statement, ".loc"))
            continue;
        if (begins(statement, ".shared")) {
            const Declared variable = read_declaration(statement);
            reader.add_shared(variable.name, variable.bytes, variable.alignment);
        } else if (statement[0] == '.') {
            throw std::runtime_error("the interpreter does not know " + statement);
        } else {
            reader.add_statement(statement);
        }
    }
}

}  // namespace

std::vector<PtxKernel> read_ptx(std::string_view commented) {
    const std::string text = without_comments(commented);
    std::vector<PtxKernel> kernels;
    for (std::size_t at = text.find(".entry "); at != std::string::npos; at = text.find(".entry ", at)) {
        const auto open = text.find('(', at);
        const auto close = text.find(')', open);
        KernelReader reader(trimmed(std::string_view(text).substr(at + 7, open - at - 7)));
        for (const std::string& parameter : split_operands(std::string_view(text).substr(open + 1, close - open - 1)))
            reader.add_parameter(read_declaration(parameter).name);
        const auto body = text.find('{', close);
        int depth = 0;
        std::size_t end = body;
        for (; end < text.size(); ++end) {
            depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
            if (depth == 0) break;
        }
        read_body(std::string_view(text).substr(body + 1, end - body - 1), reader);
        kernels.push_back(reader.finish());
        at = end;
    }
    return kernels;
}

}  // namespace meniscus::benchmarks
