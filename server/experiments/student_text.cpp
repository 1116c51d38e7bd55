#include "server/experiments/student_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

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
    bool formula = false;
    std::size_t opened = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const char next = i + 1 < text.size() ? text[i + 1] : '\0';
        if (static_cast<unsigned char>(c) < 0x20 && c != '\n')
            return refuse(i, "holds a control character", "take it out");
        if (c == '$') {
            formula = !formula;
            opened = i;
            if (next == '$') ++i;
            continue;
        }
        if (c == '<' && (is_letter(next) || next == '/' || next == '!' || next == '?'))
            return refuse(
                i, "looks like HTML", "write plain text; a sign for less needs a space after it"
            );
        if (!formula && c == ']' && next == '(')
            return refuse(i, "looks like a link", "name the source in words");
        if (!formula || c != '\\') continue;
        std::size_t end = i + 1;
        while (end < text.size() && is_letter(text[end]))
            ++end;
        const std::string_view command = text.substr(i + 1, end - i - 1);
        const bool known = std::find(kFormulaCommands.begin(), kFormulaCommands.end(), command) !=
                           kFormulaCommands.end();
        const bool sign = command.empty() && kFormulaSigns.find(next) != std::string::npos;
        if (!known && !sign)
            return refuse(
                i,
                "is no command for formulas here",
                "use plain symbols, \\frac, \\sqrt, Greek letters and the like"
            );
        i = std::max(end - 1, i + (sign ? 1U : 0U));
    }
    if (formula) return refuse(opened, "begins a formula that does not end", "close it with $");
    return {};
}

}  // namespace kinectlab::experiments
