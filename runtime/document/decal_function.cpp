#include "runtime/document/decal_function.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include "runtime/glsl/shader_sources.h"

namespace loam {

namespace {

using Names = std::set<std::string, std::less<>>;

const Names kTypes = {"void",  "bool",  "int",   "uint",  "float", "vec2",  "vec3",  "vec4", "ivec2", "ivec3",
                      "ivec4", "uvec2", "uvec3", "uvec4", "bvec2", "bvec3", "bvec4", "mat2", "mat3",  "mat4"};
const Names kKeywords = {"const",    "in",    "out",  "inout",  "if",   "else",    "for",   "return",
                         "continue", "break", "true", "switch", "case", "default", "false", "precise"};
// Refused by name, so that the sentence says what is wrong.
const Names kForbidden = {"while",    "do",         "goto",     "discard",      "struct",    "uniform",
                          "buffer",   "layout",     "shared",   "varying",      "attribute", "double",
                          "asm",      "subroutine", "demote",   "sampler",      "texture",   "image",
                          "coherent", "volatile",   "restrict", "readonly",     "writeonly", "invariant",
                          "centroid", "flat",       "smooth",   "noperspective"};
// Of GLSL: functions of their arguments alone. No derivatives, which depend on neighbours.
const Names kBuiltins = {"radians",
                         "degrees",
                         "sin",
                         "cos",
                         "tan",
                         "asin",
                         "acos",
                         "atan",
                         "sinh",
                         "cosh",
                         "tanh",
                         "asinh",
                         "acosh",
                         "atanh",
                         "pow",
                         "exp",
                         "log",
                         "exp2",
                         "log2",
                         "sqrt",
                         "inversesqrt",
                         "abs",
                         "sign",
                         "floor",
                         "trunc",
                         "round",
                         "roundEven",
                         "ceil",
                         "fract",
                         "mod",
                         "min",
                         "max",
                         "clamp",
                         "mix",
                         "step",
                         "smoothstep",
                         "isnan",
                         "isinf",
                         "length",
                         "distance",
                         "dot",
                         "cross",
                         "normalize",
                         "faceforward",
                         "reflect",
                         "refract",
                         "lessThan",
                         "lessThanEqual",
                         "greaterThan",
                         "greaterThanEqual",
                         "equal",
                         "notEqual",
                         "any",
                         "all",
                         "not",
                         "transpose",
                         "determinant",
                         "inverse",
                         "matrixCompMult",
                         "outerProduct",
                         "floatBitsToUint",
                         "floatBitsToInt",
                         "uintBitsToFloat",
                         "intBitsToFloat"};
// Of function_calls.glsl, and what they cost in steps.
const std::map<std::string, int64_t, std::less<>> kCalls = {{"random", 40}, {"noise", 90}, {"fbm", 800},
                                                            {"cells", 700}, {"ramp", 15},  {"srgb", 30},
                                                            {"detail", 8},  {"Place", 1},  {"Surface", 1}};
constexpr int kMostTurns = 256;
// Compilers walk what is nested by calling themselves: these keep them, and us, far from the end of the stack.
constexpr int kMostNested = 64;                // braces, brackets, ifs without braces, links of else
constexpr int kMostTokensOfStatement = 2'000;  // operators nest too

struct Token {
    enum class Kind { name, number, mark } kind;
    std::string_view text;
    int line;
};

bool is_name_start(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}
bool is_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::string file_of(const std::string& name) {
    return "decals/" + name + ".glsl";
}

template <typename... Args>
Error at_line(const std::string& name, int line, fmt::format_string<Args...> format, Args&&... args) {
    return error("{}:{}: {}", file_of(name), line, fmt::format(format, std::forward<Args>(args)...));
}

// Comments out of the way, places and lines as they were.
std::string without_comments(std::string text) {
    enum { code, line, block } in = code;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
        if (in == code && c == '/' && (next == '/' || next == '*')) {
            in = next == '/' ? line : block;
            text[i] = text[i + 1] = ' ';
            ++i;
        } else if (in == line && c == '\n') {
            in = code;
        } else if (in == block && c == '*' && next == '/') {
            text[i] = text[i + 1] = ' ';
            ++i;
            in = code;
        } else if (in != code && c != '\n') {
            text[i] = ' ';
        }
    }
    return text;
}

// `code` is without comments and outlives the tokens.
Result<std::vector<Token>> tokens_of(const std::string& name, const std::string& code) {
    constexpr std::string_view kMarks = "+-*/%<>=!&|^~?:;,.(){}[]";
    constexpr std::string_view kTwo[] = {"++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
                                         "<=", ">=", "==", "!=", "&&", "||", "^^", "<<", ">>"};
    std::vector<Token> tokens;
    int line = 1;
    for (size_t i = 0; i < code.size();) {
        const char c = code[i];
        if (c == '\n') ++line;
        if (std::isspace(static_cast<unsigned char>(c))) {
            ++i;
            continue;
        }
        size_t end = i + 1;
        Token::Kind kind = Token::Kind::mark;
        const char next = end < code.size() ? code[end] : '\0';
        if (is_name_start(c)) {
            while (end < code.size() && is_name(code[end])) ++end;
            kind = Token::Kind::name;
        } else if (std::isdigit(static_cast<unsigned char>(c)) ||
                   (c == '.' && std::isdigit(static_cast<unsigned char>(next)))) {
            while (end < code.size() && (is_name(code[end]) || code[end] == '.' ||
                                         ((code[end] == '+' || code[end] == '-') &&
                                          (code[end - 1] == 'e' || code[end - 1] == 'E'))))
                ++end;
            kind = Token::Kind::number;
        } else if (c == '#') {
            return at_line(name, line, "a decal's function has no directives (#)");
        } else if (kMarks.find(c) == std::string_view::npos) {
            return at_line(name, line, "there is no place for this character here");
        } else if (std::find(std::begin(kTwo), std::end(kTwo), std::string_view(code).substr(i, 2)) !=
                   std::end(kTwo)) {
            end = i + 2;
            if (end < code.size() && code[end] == '=' && (c == '<' || c == '>') && code[i + 1] == c) ++end;
        }
        tokens.push_back({kind, std::string_view(code).substr(i, end - i), line});
        i = end;
    }
    return tokens;
}

bool is_assignment(std::string_view mark) {
    static const Names kAssign = {
        "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "++", "--", "<<=", ">>="};
    return kAssign.count(mark) > 0;
}

// "//@ name value min max what it is"
Result<FunctionParameter> parameter_of(const std::string& name, int line, std::string_view text) {
    std::vector<std::string> words;
    FunctionParameter p;
    size_t at = 0;
    while (words.size() < 4) {
        while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
        size_t end = at;
        while (end < text.size() && !std::isspace(static_cast<unsigned char>(text[end]))) ++end;
        if (end == at) break;
        words.emplace_back(text.substr(at, end - at));
        at = end;
    }
    if (words.size() < 4) return at_line(name, line, "a parameter is \"//@ name value min max what it is\"");
    p.name = words[0];
    for (const auto& [word, value] : {std::pair(1, &p.value), {2, &p.min}, {3, &p.max}}) {
        const std::string& w = words[size_t(word)];
        const auto [end, failed] = std::from_chars(w.data(), w.data() + w.size(), *value);
        if (failed != std::errc() || end != w.data() + w.size() || !(std::abs(*value) <= 1.0e6))
            return at_line(name, line, "\"{}\" of the parameter {} is no number within ±1,000,000", w,
                           p.name);
    }
    if (!is_name_start(p.name[0]) || !std::all_of(p.name.begin(), p.name.end(), is_name) ||
        kTypes.count(p.name) || kKeywords.count(p.name) || kForbidden.count(p.name) ||
        kBuiltins.count(p.name) || kCalls.count(p.name))
        return at_line(name, line, "\"{}\" is no name for a parameter", p.name);
    if (!(p.min < p.max) || p.value < p.min || p.value > p.max)
        return at_line(name, line, "the parameter {} is {} in a range of {} … {}", p.name, p.value, p.min,
                       p.max);
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
    p.says = text.substr(at);
    while (!p.says.empty() && std::isspace(static_cast<unsigned char>(p.says.back()))) p.says.pop_back();
    return p;
}

Status read_comments(DecalFunction& function) {
    int line = 0;
    for (size_t at = 0; at < function.text.size(); ++line) {
        const size_t end = std::min(function.text.find('\n', at), function.text.size());
        const std::string_view row = std::string_view(function.text).substr(at, end - at);
        at = end + 1;
        if (line == 0 && row.starts_with("//") && !row.starts_with("//@")) {
            const size_t from = row.find_first_not_of(" \t", 2);
            if (from != std::string_view::npos) function.says = row.substr(from);
        }
        if (!row.starts_with("//@")) continue;
        auto parameter = parameter_of(function.name, line + 1, row.substr(3));
        if (!parameter) return parameter.error();
        for (const FunctionParameter& other : function.parameters)
            if (other.name == parameter->name)
                return at_line(function.name, line + 1, "the parameter {} is there twice", other.name);
        if (function.parameters.size() == kMostFunctionParameters)
            return at_line(function.name, line + 1, "the limit is {} parameters", kMostFunctionParameters);
        function.parameters.push_back(std::move(*parameter));
    }
    return {};
}

// Walks a text once: that it keeps to the rules, and how many steps it may take.
class Checker {
  public:
    Checker(DecalFunction& function, std::vector<Token> tokens)
        : function_(function), tokens_(std::move(tokens)) {}

    Status run() {
        while (at_ < tokens_.size()) {
            LOAM_TRY(is("const") ? constant() : definition());
        }
        const auto decal = steps_.find("decal");
        if (decal == steps_.end())
            return fail_at(1, "there is no \"void decal(Place at, inout Surface s)\" in it");
        function_.has_relief = steps_.count("relief") > 0;
        // Normals are made of four heights.
        function_.steps = decal->second + (function_.has_relief ? 4 * steps_.at("relief") : 0);
        if (function_.steps > kMostFunctionSteps)
            return fail_at(1, "it may take {} steps at a place, the limit is {}: fewer turns of its loops",
                           function_.steps, kMostFunctionSteps);
        return {};
    }

  private:
    [[nodiscard]] bool is(std::string_view text, size_t ahead = 0) const {
        return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].text == text;
    }
    [[nodiscard]] bool is_kind(Token::Kind kind, size_t ahead = 0) const {
        return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].kind == kind;
    }
    [[nodiscard]] bool is_type(size_t ahead = 0) const {
        if (!is_kind(Token::Kind::name, ahead)) return false;
        const std::string_view text = tokens_[at_ + ahead].text;
        return kTypes.count(text) || text == "Place" || text == "Surface";
    }
    [[nodiscard]] int line() const {
        return tokens_.empty() ? 1 : tokens_[std::min(at_, tokens_.size() - 1)].line;
    }
    template <typename... Args>
    [[nodiscard]] Error fail_at(int line, fmt::format_string<Args...> format, Args&&... args) const {
        return at_line(function_.name, line, format, std::forward<Args>(args)...);
    }
    template <typename... Args>
    [[nodiscard]] Error fail(fmt::format_string<Args...> format, Args&&... args) const {
        return fail_at(line(), format, std::forward<Args>(args)...);
    }

    // const TYPE name = …;
    Status constant() {
        const size_t begin = at_;
        const bool whole = is("int", 1) && is("=", 3) && is_kind(Token::Kind::number, 4) && is(";", 5);
        if (whole)
            if (const auto value = whole_number(tokens_[at_ + 4].text))
                constants_[std::string(tokens_[at_ + 2].text)] = *value;
        while (at_ < tokens_.size() && !is(";")) {
            if (is("{")) return fail("a list in a constant: give its members one by one");
            LOAM_TRY(token(1));
        }
        if (at_ == tokens_.size()) return fail_at(tokens_[begin].line, "a constant without its \";\"");
        ++at_;
        return {};
    }

    Status definition() {
        if (!is_type() || !is_kind(Token::Kind::name, 1) || !is("(", 2))
            return fail("outside of functions there are only functions and \"const\": \"{}\"",
                        tokens_[at_].text);
        const std::string name(tokens_[at_ + 1].text);
        const int begin = line();
        if (kBuiltins.count(name) || kCalls.count(name) || kTypes.count(name) || kKeywords.count(name) ||
            kForbidden.count(name))
            return fail("{} cannot be defined again", name);
        if (name == "decal" &&
            !signature({"void", "decal", "(", "Place", "", ",", "inout", "Surface", "", ")"}))
            return fail("decal is \"void decal(Place at, inout Surface s)\"");
        if (name == "relief" && !signature({"float", "relief", "(", "Place", "", ")"}))
            return fail("relief is \"float relief(Place at)\"");
        const bool again = steps_.count(name) > 0;
        if (again) return fail("{} is defined twice", name);
        at_ += 3;
        while (at_ < tokens_.size() && !is(")")) {
            if ((is("out") || is("inout")) && (is("int", 1) || is("uint", 1)))
                return fail("a function cannot give back {} through its arguments: return it",
                            tokens_[at_ + 1].text);
            if (is("[")) return fail("there are no arrays");
            if (is_kind(Token::Kind::name) && kForbidden.count(tokens_[at_].text))
                return fail("\"{}\" has no place in a decal's function", tokens_[at_].text);
            ++at_;
        }
        ++at_;
        if (!is("{"))
            return fail_at(begin, "{} has no body: functions are defined before they are called", name);
        cost_ = 1;
        LOAM_TRY(block(1));
        steps_[name] = cost_;
        return {};
    }

    // Empty words stand for any name.
    [[nodiscard]] bool signature(std::initializer_list<std::string_view> words) const {
        size_t i = 0;
        for (const std::string_view word : words) {
            if (word.empty() ? !is_kind(Token::Kind::name, i) : !is(word, i)) return false;
            ++i;
        }
        return true;
    }

    // From its "{" to after its "}".
    Status block(int64_t turns) {
        const int begin = line();
        if (++braces_ > kMostNested) return fail("more than {} blocks in one another", kMostNested);
        const int outer = std::exchange(elses_around_, elses_);
        end_statement();
        ++at_;
        while (at_ < tokens_.size() && !is("}")) {
            if (is("{"))
                LOAM_TRY(block(turns));
            else if (is("for"))
                LOAM_TRY(loop(turns));
            else
                LOAM_TRY(token(turns));
        }
        if (at_ == tokens_.size()) return fail_at(begin, "this \"{{\" is never closed");
        ++at_;
        --braces_;
        elses_ = std::exchange(elses_around_, outer);
        end_statement();
        return {};
    }

    [[nodiscard]] static std::optional<int64_t> whole_number(std::string_view text) {
        int64_t value = 0;
        const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failed != std::errc() || end != text.data() + text.size() || std::abs(value) > 1'000'000)
            return {};
        return value;
    }
    // A whole number as written or a constant, with a sign; moves on.
    [[nodiscard]] std::optional<int64_t> bound() {
        const bool negative = is("-");
        if (negative) ++at_;
        std::optional<int64_t> value;
        if (is_kind(Token::Kind::number)) value = whole_number(tokens_[at_].text);
        if (is_kind(Token::Kind::name))
            if (const auto it = constants_.find(tokens_[at_].text); it != constants_.end())
                value = it->second;
        ++at_;
        if (value && negative) value = -*value;
        return value;
    }

    // for (int i = FROM; i < TO; ++i) { … }
    Status loop(int64_t turns) {
        const int begin = line();
        const auto refuse = [&] {
            return fail_at(begin,
                           "a loop is \"for (int i = 0; i < 8; ++i) {{ … }}\", its bounds whole numbers or "
                           "constants");
        };
        if (!is("(", 1) || !is("int", 2) || !is_kind(Token::Kind::name, 3) || !is("=", 4)) return refuse();
        const std::string counter(tokens_[at_ + 3].text);
        at_ += 5;
        const auto from = bound();
        if (!from || !is(";") || !is(counter, 1) || !(is("<", 2) || is("<=", 2))) return refuse();
        const bool last_too = is("<=", 2);
        at_ += 3;
        const auto to = bound();
        if (!to || !is(";")) return refuse();
        ++at_;
        int64_t step = 1;
        if ((is("++") && is(counter, 1)) || (is(counter) && is("++", 1))) {
            at_ += 2;
        } else if (is(counter) && is("+=", 1)) {
            at_ += 2;
            const auto by = bound();
            if (!by || *by < 1) return refuse();
            step = *by;
        } else {
            return refuse();
        }
        if (!is(")") || !is("{", 1)) return refuse();
        ++at_;
        const int64_t here = std::max<int64_t>(0, (*to - *from + (last_too ? 1 : 0) + step - 1) / step);
        if (here > kMostTurns) return fail_at(begin, "a loop of {} turns, the limit is {}", here, kMostTurns);
        counters_.push_back(counter);
        LOAM_TRY(block(std::min<int64_t>(turns * std::max<int64_t>(here, 1), kMostFunctionSteps * 2)));
        counters_.pop_back();
        return {};
    }

    // After it; what is not an "else" ends a chain of them.
    void end_statement() {
        length_ = ifs_ = brackets_ = 0;
        if (!is("else")) elses_ = elses_around_;
    }

    Status nesting(std::string_view text) {
        if (++length_ > kMostTokensOfStatement)
            return fail("a statement of more than {} words and marks: make several of it", kMostTokensOfStatement);
        brackets_ += text == "(" ? 1 : text == ")" ? -1 : 0;
        ifs_ += text == "if" ? 1 : 0;
        elses_ += text == "else" ? 1 : 0;
        if (std::max({brackets_, ifs_, elses_}) > kMostNested)
            return fail("more than {} brackets, ifs or elses in one another", kMostNested);
        return {};
    }

    // One token of a body, executed `turns` times.
    Status token(int64_t turns) {
        const Token t = tokens_[at_];
        LOAM_TRY(nesting(t.text));
        cost_ = std::min<int64_t>(cost_ + turns, kMostFunctionSteps * 4);
        const bool field = at_ > 0 && tokens_[at_ - 1].text == ".";
        if (t.text == "[") {
            if (!is_kind(Token::Kind::number, 1) || !is("]", 2))
                return fail("there are no arrays, and what stands in [ ] must be a number");
        } else if (t.kind == Token::Kind::name && !field) {
            LOAM_TRY(name(t, turns));
        }
        ++at_;
        if (t.text == ";") end_statement();
        return {};
    }

    Status name(const Token& t, int64_t turns) {
        const std::string text(t.text);
        if (text == "for") return fail("a loop stands in {{ }} of its own");
        if (kForbidden.count(text)) {
            if (text == "while" || text == "do")
                return fail("{} has no bound: a loop is \"for (int i = 0; i < 8; ++i) {{ … }}\"", text);
            return fail("\"{}\" has no place in a decal's function", text);
        }
        if (std::find(counters_.begin(), counters_.end(), text) != counters_.end() &&
            (is_assignment_at(1) ||
             (at_ > 0 && (tokens_[at_ - 1].text == "++" || tokens_[at_ - 1].text == "--"))))
            return fail("{} counts the turns of a loop and cannot be changed in it", text);
        if (!is("(", 1) || kKeywords.count(text) || kTypes.count(text) || kBuiltins.count(text)) return {};
        if (const auto call = kCalls.find(text); call != kCalls.end()) {
            cost_ = std::min<int64_t>(cost_ + call->second * turns, kMostFunctionSteps * 4);
            return {};
        }
        if (const auto own = steps_.find(text); own != steps_.end()) {
            cost_ = std::min<int64_t>(cost_ + own->second * turns, kMostFunctionSteps * 4);
            return {};
        }
        return fail("{} cannot be called: it is neither defined above nor one of the functions there are",
                    text);
    }

    [[nodiscard]] bool is_assignment_at(size_t ahead) const {
        return at_ + ahead < tokens_.size() && is_assignment(tokens_[at_ + ahead].text);
    }

    DecalFunction& function_;
    std::vector<Token> tokens_;
    size_t at_ = 0;
    int64_t cost_ = 0;
    int braces_ = 0;
    int length_ = 0, ifs_ = 0, brackets_ = 0;  // of the statement
    int elses_ = 0, elses_around_ = 0;         // of the chain, and of those that the block stands in
    std::map<std::string, int64_t, std::less<>> steps_;      // of functions defined so far
    std::map<std::string, int64_t, std::less<>> constants_;  // whole numbers
    std::vector<std::string> counters_;                      // of the loops around
};

// The text with "u3_" before its own names, "fn_" before what it is given; lines stay.
std::string renamed(const DecalFunction& function, size_t number) {
    const std::string code = without_comments(function.text);
    const auto tokens = tokens_of(function.name, code);
    std::string out;
    const char* from = code.data();
    std::string_view before;
    for (const Token& t : *tokens) {
        out.append(from, t.text.data());
        if (t.kind == Token::Kind::name && before != "." && !kTypes.count(t.text) &&
            !kKeywords.count(t.text) && !kBuiltins.count(t.text))
            out += kCalls.count(t.text) ? "fn_" : fmt::format("u{}_", number);
        out += t.text;
        from = t.text.data() + t.text.size();
        before = t.text;
    }
    return out.append(from, code.data() + code.size());
}

// The line of a file where SPIR-V divides signed integers; 0: nowhere. That is undefined by zero, and of the
// smallest number by -1, and some devices' processors trap.
int int_division(std::span<const uint32_t> words, const std::string& file) {
    constexpr uint32_t kOpString = 7, kOpLine = 8, kOpSDiv = 135, kOpSRem = 138, kOpSMod = 139;
    uint32_t file_id = 0, line = 0;
    bool here = false;
    for (size_t i = 5, length = 0; i < words.size(); i += length) {
        length = std::max(words[i] >> 16, 1u);
        const uint32_t op = words[i] & 0xffffu;
        if (op == kOpString && file == reinterpret_cast<const char*>(&words[i + 2])) file_id = words[i + 1];
        if (op == kOpLine) {
            here = words[i + 1] == file_id;
            line = words[i + 2];
        }
        if (here && (op == kOpSDiv || op == kOpSRem || op == kOpSMod)) return int(line);
    }
    return 0;
}

}  // namespace

Status check_function_name(const std::string& name) {
    constexpr size_t kLongest = 60;
    const auto plain = [](char c) { return is_name(c) || c == '-'; };
    if (name.empty() || name.size() > kLongest || !std::all_of(name.begin(), name.end(), plain))
        return error("\"{}\" is no name of a decal's function: 1 to {} letters, digits, _ and -", name,
                     kLongest);
    return {};
}

Result<DecalFunction> read_function(const std::string& name, std::string text) {
    LOAM_TRY(check_function_name(name));
    if (text.size() > kLargestFunction_bytes)
        return at_line(name, 1, "it has {} bytes, the limit is {}", text.size(), kLargestFunction_bytes);
    std::erase(text, '\r');
    DecalFunction function;
    function.name = name;
    function.text = std::move(text);
    LOAM_TRY(read_comments(function));
    const std::string code = without_comments(function.text);
    auto tokens = tokens_of(name, code);
    if (!tokens) return tokens.error();
    LOAM_TRY(Checker(function, std::move(*tokens)).run());
    return function;
}

Status check_parameters(const DecalFunction& function, const std::map<std::string, double>& parameters) {
    for (const auto& [name, value] : parameters) {
        const auto known = std::find_if(function.parameters.begin(), function.parameters.end(),
                                        [&](const FunctionParameter& p) { return p.name == name; });
        if (known == function.parameters.end()) {
            std::string names;
            for (const FunctionParameter& p : function.parameters)
                names += (names.empty() ? "" : ", ") + p.name;
            return error("the function {} has no parameter \"{}\" (it has: {})", function.name, name,
                         names.empty() ? "none" : names);
        }
        if (value < known->min || value > known->max)
            return error("the parameter {} of {} is {}, must be {} … {}", name, function.name, value,
                         known->min, known->max);
    }
    return {};
}

std::vector<double> parameter_values(const DecalFunction& function,
                                     const std::map<std::string, double>& parameters) {
    std::vector<double> values;
    for (const FunctionParameter& p : function.parameters) {
        const auto set = parameters.find(p.name);
        values.push_back(set == parameters.end() ? p.value : std::clamp(set->second, p.min, p.max));
    }
    return values;
}

glsl::Texts shader_texts(std::span<const DecalFunction* const> functions) {
    glsl::Texts texts;
    std::string list = "#define LOAM_DECAL_FUNCTIONS\nconst bool kDecalFunctions = true;\n", run;
    for (size_t i = 0; i < functions.size(); ++i) {
        const DecalFunction& f = *functions[i];
        std::string set;
        for (size_t p = 0; p < f.parameters.size(); ++p) {
            list += fmt::format("float u{}_{};\n", i, f.parameters[p].name);
            set += fmt::format("        u{}_{} = decal.parameters_{}.{};\n", i, f.parameters[p].name,
                               p < 4 ? 'a' : 'b', "xyzw"[p % 4]);
        }
        list += fmt::format("#include \"{}\"\n", file_of(f.name));
        texts[file_of(f.name)] = renamed(f, i);
        // Heights half a texel to either side.
        if (f.has_relief)
            set += fmt::format(
                "        fn_Place west = at, east = at, south = at, north = at;\n"
                "        float h = 0.5 * at.texel_m;\n"
                "        west.p.x -= h; east.p.x += h; south.p.y -= h; north.p.y += h;\n"
                "        s.slope += vec2(u{0}_relief(east) - u{0}_relief(west), u{0}_relief(north) - "
                "u{0}_relief(south)) / at.texel_m;\n",
                i);
        run += fmt::format(
            "    if (decal.function == {}u) {{\n{}        u{}_decal(at, s);\n        return;\n    }}\n",
            i + 1, set, i);
    }
    list += "void run_function(PaintDecal decal, fn_Place at, inout fn_Surface s) {\n" + run + "}\n";
    texts["shaders/texture/decal_functions.glsl"] = std::move(list);
    return texts;
}

std::string plain_message(const std::string& message) {
    static const std::regex kPrefix("\\b(u[0-9]+_|fn_)|'' : +");
    // What follows from it elsewhere is of no use.
    std::string own;
    for (size_t at = 0; at < message.size();) {
        const size_t end = std::min(message.find('\n', at), message.size());
        const std::string_view line = std::string_view(message).substr(at, end - at);
        at = end + 1;
        if (!line.starts_with("decals/")) continue;
        if (!own.empty()) own += '\n';
        own += line;
    }
    return std::regex_replace(own.empty() ? message : own, kPrefix, "");
}

Status compile_function(const DecalFunction& function) {
    const DecalFunction* only = &function;
    const auto words = glsl::compile_with("texture/paint.frag", shader_texts({&only, 1}), glsl::embedded_text,
                                          glsl::Lines::yes);
    if (!words) return error("{}", plain_message(words.message()));
    if (const int line = int_division(*words, file_of(function.name)); line > 0)
        return at_line(
            function.name, line,
            "dividing int by int, with / or %, may stop the program where it cannot be done: divide "
            "float or uint");
    return {};
}

std::span<const std::pair<std::string, std::string>> shipped_functions() {
    static const auto kShipped = [] {
        std::vector<std::pair<std::string, std::string>> list;
        for (const glsl::ShaderSource& source : glsl::shader_sources()) {
            constexpr std::string_view kFolder = "decals/", kSuffix = ".glsl";
            if (!source.name.starts_with(kFolder)) continue;
            const std::string_view stem =
                source.name.substr(kFolder.size(), source.name.size() - kFolder.size() - kSuffix.size());
            list.emplace_back(stem, source.text);
        }
        return list;
    }();
    return kShipped;
}

}  // namespace loam
