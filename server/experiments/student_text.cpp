#include "server/experiments/student_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace kinectlab::experiments {
namespace {

constexpr std::size_t kMostBytes = 20'000;
const std::string kFormulaSigns = ",;:! {}\\%&|";  // after a backslash

// Whatever sets a symbol; nothing that loads, links, defines or styles.
constexpr std::array<std::string_view, 83> kFormulaCommands{
    "alpha",  "beta",   "gamma",  "delta",    "epsilon", "varepsilon", "zeta",       "eta",
    "theta",  "kappa",  "lambda", "mu",       "nu",      "xi",         "pi",         "rho",
    "sigma",  "tau",    "phi",    "varphi",   "chi",     "psi",        "omega",      "Gamma",
    "Delta",  "Theta",  "Lambda", "Xi",       "Pi",      "Sigma",      "Phi",        "Psi",
    "Omega",  "frac",   "dfrac",  "tfrac",    "sqrt",    "sin",        "cos",        "tan",
    "arcsin", "arctan", "ln",     "log",      "exp",     "cdot",       "times",      "pm",
    "approx", "sim",    "le",     "ge",       "leq",     "geq",        "ne",         "ll",
    "gg",     "propto", "infty",  "sum",      "int",     "partial",    "dot",        "ddot",
    "vec",    "hat",    "bar",    "overline", "mathbf",  "mathrm",     "text",       "left",
    "right",  "quad",   "qquad",  "circ",     "to",      "rightarrow", "Rightarrow", "lVert",
    "rVert",  "ldots",  "cdots"};

constexpr const char* kEndless = "begins a formula that does not end";

/// The formula that is being read; none where the mark is empty.
struct Formula {
    std::string_view mark;  ///< "$" or "$$", which ends it too
    std::size_t opened = 0;
    std::vector<std::size_t> open_braces;
    std::vector<std::size_t> open_lefts;
};

std::string closing(const Formula& formula) {
    return fmt::format("close it with {}, in the same paragraph if it stands in one", formula.mark);
}

bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

int line_of(std::string_view text, std::size_t at) {
    return 1 + static_cast<int>(
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')
               );
}

/// The word at the place, for a message.
std::string excerpt(std::string_view text, std::size_t at) {
    return std::string(text.substr(at, 24));
}

std::string_view command_at(std::string_view text, std::size_t backslash) {
    std::size_t end = backslash + 1;
    while (end < text.size() && is_letter(text[end]))
        ++end;
    return text.substr(backslash + 1, end - backslash - 1);
}

bool is_known(std::string_view command) {
    return std::find(kFormulaCommands.begin(), kFormulaCommands.end(), command) !=
           kFormulaCommands.end();
}

/// Whether an empty line, or a point of a list, follows: the page cuts the text there.
bool ends_paragraph(std::string_view text, std::size_t at) {
    if (text[at] != '\n') return false;
    const std::size_t next = text.find_first_not_of(" \t", at + 1);
    return next != std::string_view::npos &&
           (text[next] == '\n' || text.substr(next).starts_with("- "));
}

}  // namespace

Result<void> check_student_text(std::string_view text, const std::string& path) {
    const auto refuse = [&](std::size_t at, const std::string& what, const std::string& cure) {
        return fail(
            ErrorCode::invalid_argument,
            path,
            fmt::format("line {}: \"{}\" {}", line_of(text, at), excerpt(text, at), what),
            cure
        );
    };
    if (text.size() > kMostBytes)
        return fail(
            ErrorCode::invalid_argument,
            path,
            fmt::format("is {} bytes long", text.size()),
            fmt::format("give at most {}", kMostBytes)
        );
    Formula formula;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const char next = i + 1 < text.size() ? text[i + 1] : '\0';
        if (static_cast<unsigned char>(c) < 0x20 && c != '\n')
            return refuse(i, "holds a control character", "take it out");
        if (c == '<' && (is_letter(next) || next == '/' || next == '!' || next == '?'))
            return refuse(
                i, "looks like HTML", "write plain text; a sign for less needs a space after it"
            );
        if (c == '$') {
            const std::string_view mark = next == '$' ? "$$" : "$";
            if (formula.mark.empty())
                formula = {mark, i};
            else if (formula.mark != mark)
                return refuse(formula.opened, kEndless, closing(formula));
            else if (!formula.open_braces.empty())
                return refuse(formula.open_braces.back(), "opens a brace", "close it with }");
            else if (!formula.open_lefts.empty())
                return refuse(formula.open_lefts.back(), "has no \\right", "give both or none");
            else
                formula = {};
            i += mark.size() - 1;
            continue;
        }
        if (formula.mark.empty()) {
            if (c == ']' && next == '(')
                return refuse(i, "looks like a link", "name the source in words");
            continue;
        }
        if (formula.mark == "$" && ends_paragraph(text, i))
            return refuse(formula.opened, kEndless, closing(formula));
        if (c == '{') formula.open_braces.push_back(i);
        if (c == '}') {
            if (formula.open_braces.empty())
                return refuse(i, "closes a brace that none opened", "take it out, or open it");
            formula.open_braces.pop_back();
        }
        if (c != '\\') continue;
        const std::string_view command = command_at(text, i);
        const bool sign = command.empty() && kFormulaSigns.find(next) != std::string::npos;
        if (!is_known(command) && !sign)
            return refuse(
                i,
                "is no command for formulas here",
                "use plain symbols, \\frac, \\sqrt, Greek letters and the like"
            );
        if (command == "left") formula.open_lefts.push_back(i);
        if (command == "right") {
            if (formula.open_lefts.empty())
                return refuse(i, "has no \\left before it", "give both or none");
            formula.open_lefts.pop_back();
        }
        i += sign ? 1U : command.size();
    }
    if (!formula.mark.empty()) return refuse(formula.opened, kEndless, closing(formula));
    return {};
}

}  // namespace kinectlab::experiments
