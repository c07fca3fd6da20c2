#include "formats/containers/pickle.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace meniscus::formats {
namespace {

/// The most values of a pickle. A program's settings and the names of its arrays are far fewer, and each array is one.
constexpr std::size_t most_values = 1'000'000;

}  // namespace

Pickle::Pickle(const ByteCursor& at, std::string_view bytes, ReadBudget& budget)
    : in_(at.name(), bytes), budget_(budget) {
    run();
}

const Pickle::Value* Pickle::find(const Value& mapping, std::string_view key) const {
    if (mapping.kind != Kind::mapping) return nullptr;
    for (std::size_t i = 0; i + 1 < mapping.items.size(); i += 2) {
        const Value& name = values_[mapping.items[i]];
        if ((name.kind == Kind::text || name.kind == Kind::bytes) && name.text == key)
            return &values_[mapping.items[i + 1]];
    }
    return nullptr;
}

void Pickle::run() {
    constexpr unsigned char stop = '.';
    for (;;) {
        const auto operation = static_cast<unsigned char>(in_.take(1)[0]);
        if (operation == stop) break;
        step(operation);
    }
    root_ = pop();
}

void Pickle::push(Value value) {
    if (values_.size() == most_values) in_.fail("a pickle of more than " + std::to_string(most_values) + " values");
    items_ += value.items.size();
    pay(sizeof(Value) + sizeof(Id) * (1 + value.items.size()));
    values_.push_back(std::move(value));
    stack_.push_back(static_cast<Id>(values_.size() - 1));
}

Pickle::Id Pickle::pop() {
    if (stack_.empty() || (!marks_.empty() && marks_.back() == stack_.size()))
        in_.fail("no pickle: byte " + std::to_string(in_.position()) + " takes a value where there is none");
    const Id id = stack_.back();
    stack_.pop_back();
    return id;
}

Pickle::Value& Pickle::top() {
    const Id id = pop();
    stack_.push_back(id);
    return values_[id];
}

std::vector<Pickle::Id> Pickle::pop_to_mark() {
    if (marks_.empty()) in_.fail("no pickle: byte " + std::to_string(in_.position()) + " ends a list that none began");
    const auto first = stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back());
    std::vector<Id> items(first, stack_.end());
    stack_.erase(first, stack_.end());
    marks_.pop_back();
    return items;
}

void Pickle::gather(std::size_t count) {
    Value list{Kind::list};
    for (std::size_t i = 0; i < count; ++i) list.items.push_back(pop());
    std::reverse(list.items.begin(), list.items.end());
    push(std::move(list));
}

void Pickle::append(Value& to, std::vector<Id> items) {
    items_ += items.size();
    if (items_ > 4 * most_values) in_.fail("a pickle of more than " + std::to_string(4 * most_values) + " items");
    pay(sizeof(Id) * items.size());
    to.items.insert(to.items.end(), items.begin(), items.end());
}

void Pickle::get(std::uint64_t place) {
    const auto found = memo_.find(place);
    if (found == memo_.end())
        in_.fail("no pickle: it uses value " + std::to_string(place) + ", which it does not have");
    if (stack_.size() >= 4 * most_values) in_.fail("a pickle of too many values");
    pay(sizeof(Id));
    stack_.push_back(found->second);
}

void Pickle::remember(std::uint64_t place) {
    constexpr std::size_t bytes_each = 64;  // of the map, a buckets' pointer included
    top();
    if (memo_.size() == most_values && !memo_.contains(place)) in_.fail("a pickle of too many values");
    pay(bytes_each);
    memo_[place] = stack_.back();
}

std::uint64_t Pickle::little_endian(std::size_t size) {
    std::uint64_t value = 0;
    const std::string_view bytes = in_.take(size);
    for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

std::int64_t Pickle::signed_integer(std::size_t size) {
    if (size > sizeof(std::int64_t)) {
        in_.take(size);
        return std::numeric_limits<std::int64_t>::max();  // of no use here
    }
    if (size == 0) return 0;
    const std::size_t unused = 64 - 8 * size;
    return static_cast<std::int64_t>(little_endian(size) << unused) >> unused;
}

void Pickle::text_of(std::uint64_t size, Kind kind) {
    in_.expect(size, 1, "bytes of a string");
    push({kind, 0, in_.take(static_cast<std::size_t>(size)), {}});
}

void Pickle::step(unsigned char operation) {
    switch (operation) {
        case 0x80:  // PROTO
            in_.take(1);
            return;
        case 0x95:  // FRAME
            in_.take(8);
            return;
        case '(':  // MARK
            if (marks_.size() == most_values) in_.fail("a pickle of too many lists");
            marks_.push_back(stack_.size());
            return;
        case '0':  // POP
            pop();
            return;
        case '1':  // POP_MARK
            pop_to_mark();
            return;
        case 'N':
            return push({});
        case 0x88:  // NEWTRUE
            return push({Kind::boolean, 1, {}, {}});
        case 0x89:  // NEWFALSE
            return push({Kind::boolean, 0, {}, {}});
        case 'J':  // BININT
            return push({Kind::integer, signed_integer(4), {}, {}});
        case 'K':  // BININT1
            return push({Kind::integer, static_cast<std::int64_t>(little_endian(1)), {}, {}});
        case 'M':  // BININT2
            return push({Kind::integer, static_cast<std::int64_t>(little_endian(2)), {}, {}});
        case 0x8a: {  // LONG1
            const std::uint64_t size = little_endian(1);
            return push({Kind::integer, signed_integer(size), {}, {}});
        }
        case 0x8b: {  // LONG4
            const std::uint64_t size = little_endian(4);
            return push({Kind::integer, signed_integer(size), {}, {}});
        }
        case 'G':  // BINFLOAT
            in_.take(8);
            return push({Kind::real});
        case 'X':  // BINUNICODE
            return text_of(little_endian(4), Kind::text);
        case 0x8c:  // SHORT_BINUNICODE
            return text_of(little_endian(1), Kind::text);
        case 0x8d:  // BINUNICODE8
            return text_of(little_endian(8), Kind::text);
        case 'B':  // BINBYTES
        case 'T':  // BINSTRING
            return text_of(little_endian(4), Kind::bytes);
        case 'C':  // SHORT_BINBYTES
        case 'U':  // SHORT_BINSTRING
            return text_of(little_endian(1), Kind::bytes);
        case 0x8e:  // BINBYTES8
        case 0x96:  // BYTEARRAY8
            return text_of(little_endian(8), Kind::bytes);
        case ')':   // EMPTY_TUPLE
        case ']':   // EMPTY_LIST
        case 0x8f:  // EMPTY_SET
            return push({Kind::list});
        case '}':  // EMPTY_DICT
            return push({Kind::mapping});
        case 't':   // TUPLE
        case 'l':   // LIST
        case 0x91:  // FROZENSET
            return push({Kind::list, 0, {}, pop_to_mark()});
        case 'd':  // DICT
            return push({Kind::mapping, 0, {}, pop_to_mark()});
        case 0x85:  // TUPLE1
        case 0x86:  // TUPLE2
        case 0x87:  // TUPLE3
            return gather(operation - 0x84U);
        case 'a': {  // APPEND
            const Id item = pop();
            return append(top(), {item});
        }
        case 'e':     // APPENDS
        case 'u':     // SETITEMS
        case 0x90: {  // ADDITEMS
            std::vector<Id> items = pop_to_mark();
            return append(top(), std::move(items));
        }
        case 's': {  // SETITEM
            const Id value = pop();
            const Id key = pop();
            return append(top(), {key, value});
        }
        case 'c': {  // GLOBAL
            in_.line();
            return push({Kind::global, 0, in_.line(), {}});
        }
        case 0x93: {  // STACK_GLOBAL
            const Id name = pop();
            pop();
            return push({Kind::global, 0, values_[name].text, {}});
        }
        case 'R':     // REDUCE
        case 0x81: {  // NEWOBJ
            gather(2);
            values_[stack_.back()].kind = Kind::object;
            return;
        }
        case 'b': {  // BUILD
            const Id state = pop();
            return append(top(), {state});
        }
        case 'q':  // BINPUT
        case 'r':  // LONG_BINPUT
            return remember(little_endian(operation == 'q' ? 1 : 4));
        case 0x94:  // MEMOIZE
            return remember(memo_.size());
        case 'h':  // BINGET
            return get(little_endian(1));
        case 'j':  // LONG_BINGET
            return get(little_endian(4));
        default:
            in_.fail("a pickle with operation " + std::to_string(operation) + " at byte " +
                     std::to_string(in_.position() - 1) + ", which is not read");
    }
}

}  // namespace meniscus::formats
