// SPDX-License-Identifier: MIT
// Calls against signatures.
#include "puppetri/lang/types.h"

#include <algorithm>

#include "puppetri/base/text.h"

namespace puppetri::lang {
namespace {

Diagnostic defect(const File& file, Span span, std::string code, const std::string& element,
                  std::string message, std::string remedy) {
    return {Severity::kError, std::move(code),    file.where(span),
            element,          std::move(message), std::move(remedy)};
}

std::string joined(std::span<const std::string> words, std::size_t most) {
    std::string out;
    for (std::size_t i = 0; i < words.size() && i < most; ++i) {
        out += i > 0 ? ", " : "";
        out += words[i];
    }
    return words.size() > most ? out + ", ..." : out;
}

// "an actor", "a movement"
std::string with_article(const std::string& noun) {
    const bool vowel =
        !noun.empty() && std::string_view("aeiou").find(noun[0]) != std::string_view::npos;
    return (vowel ? "an " : "a ") + noun;
}

struct Check {
    const File& file;
    const Resolver& resolver;
    const std::string& element;
    Diagnostics& out;

    bool wrong(Span span, std::string code, std::string message, std::string remedy) {
        out.push_back(
            defect(file, span, std::move(code), element, std::move(message), std::move(remedy)));
        return false;
    }
    bool wrong_type(const Expr& value, const Type& wanted, const std::string& found) {
        return wrong(value.span, "wrong-type",
                     to_text(wanted) + " is wanted here, this is " + found,
                     "give " + to_text(wanted));
    }

    // The dimension of a value where it can be told from the text alone and from the types of
    // names; nullopt when a name has no number, which is reported.
    std::optional<Dimension> dimension_of(const Expr& e) {
        switch (e.kind) {
            case ExprKind::kNumber: {
                const std::optional<Unit> unit = e.unit.empty() ? Unit{} : find_unit(e.unit);
                return unit ? unit->dimension : Dimension{};
            }
            case ExprKind::kCount:
            case ExprKind::kCountReady:
                return Dimension{};
            case ExprKind::kPath: {
                const std::optional<Type> type = resolver.type_of(e.path);
                if (!type) {
                    unknown(e.path);
                    return std::nullopt;
                }
                if (type->kind == TypeKind::kQuantity || type->kind == TypeKind::kNumber ||
                    type->kind == TypeKind::kInteger) {
                    return type->dimension;
                }
                wrong(e.span, "wrong-type", "a number is wanted here, this is " + to_text(*type),
                      "give a number");
                return std::nullopt;
            }
            case ExprKind::kUnary:
                return dimension_of(e.args[0].value);
            case ExprKind::kConditional:
                return same(e, 1);
            case ExprKind::kRange:
                return same(e, 0);
            case ExprKind::kBinary:
                return of_binary(e);
            case ExprKind::kCall: {
                // A distribution has the dimension of its arguments; which ones exist is the
                // caller's to check.
                std::optional<Dimension> out_dimension = Dimension{};
                for (const Argument& argument : e.args) {
                    const std::optional<Dimension> of = dimension_of(argument.value);
                    out_dimension = of && *of != Dimension{} ? of : out_dimension;
                }
                return out_dimension;
            }
            default:
                wrong(e.span, "wrong-type", "a number is wanted here", "give a number");
                return std::nullopt;
        }
    }
    std::optional<Dimension> same(const Expr& e, std::size_t from) {
        std::optional<Dimension> first = dimension_of(e.args[from].value);
        for (std::size_t i = from + 1; i < e.args.size(); ++i) {
            const std::optional<Dimension> next = dimension_of(e.args[i].value);
            if (first && next && *first != *next) {
                wrong(e.args[i].value.span, "wrong-unit",
                      "this is " + to_text(*next) + ", and before it stands " + to_text(*first),
                      "give both the same unit");
                return std::nullopt;
            }
        }
        return first;
    }
    std::optional<Dimension> of_binary(const Expr& e) {
        switch (e.op) {
            case Op::kAdd:
            case Op::kSubtract:
            case Op::kMod:
            case Op::kDiv:
                return same(e, 0);
            case Op::kMultiply:
            case Op::kDivide: {
                std::optional<Dimension> out_dimension = dimension_of(e.args[0].value);
                const int sign = e.op == Op::kMultiply ? 1 : -1;
                for (std::size_t i = 1; i < e.args.size(); ++i) {
                    const std::optional<Dimension> next = dimension_of(e.args[i].value);
                    if (!out_dimension || !next) {
                        return std::nullopt;
                    }
                    const auto add = [sign](std::int8_t& to, std::int8_t by) {
                        to = static_cast<std::int8_t>(to + sign * by);
                    };
                    add(out_dimension->length, next->length);
                    add(out_dimension->time, next->time);
                    add(out_dimension->mass, next->mass);
                    add(out_dimension->angle, next->angle);
                    add(out_dimension->frame, next->frame);
                }
                return out_dimension;
            }
            case Op::kPower: {
                const std::optional<Dimension> base = dimension_of(e.args[0].value);
                if (base && *base != Dimension{}) {
                    wrong(e.span, "wrong-unit", "a power of " + to_text(*base) + " has no use here",
                          "multiply instead");
                    return std::nullopt;
                }
                return base;
            }
            default:
                wrong(e.span, "wrong-type", "a number is wanted here, this is yes or no",
                      "give a number");
                return std::nullopt;
        }
    }

    void unknown(const Path& path) {
        out.push_back(unknown_name(file.where(path.span), "name", to_text(path),
                                   resolver.names_near(path), element));
    }

    bool quantity(const Expr& value, const Type& wanted) {
        const std::optional<Dimension> found = dimension_of(value);
        if (!found) {
            return false;
        }
        // Frames are times once a rate is known.
        const bool frames_as_time =
            wanted.dimension == dimension::kTime && *found == dimension::kFrame;
        if (*found != wanted.dimension && !frames_as_time) {
            const std::string_view unit = example_unit(wanted.dimension);
            return wrong(value.span, "wrong-unit",
                         to_text(wanted.dimension) + " is wanted here, this is " + to_text(*found),
                         unit.empty() ? "leave the unit out" : "write it in " + std::string(unit));
        }
        return true;
    }

    bool point(const Expr& value, const Type& wanted) {
        if (value.kind == ExprKind::kPath) {
            return thing(value, wanted);
        }
        if (value.kind != ExprKind::kTuple || value.args.size() != 3) {
            return wrong(value.span, "wrong-type", "a point of three numbers is wanted here",
                         "write (x, y, z) " + std::string(example_unit(wanted.dimension)));
        }
        bool good = true;
        for (const Argument& argument : value.args) {
            if (value.unit.empty()) {
                good = quantity(argument.value, wanted) && good;
                continue;
            }
            const std::optional<Dimension> found = dimension_of(argument.value);
            if (found && *found != Dimension{}) {
                good =
                    wrong(argument.value.span, "wrong-unit",
                          "this number has a unit, and so has the whole point", "keep one of them");
            }
            good = found.has_value() && good;
        }
        const std::optional<Unit> unit = value.unit.empty() ? std::nullopt : find_unit(value.unit);
        if (unit && unit->dimension != wanted.dimension) {
            good = wrong(
                value.unit_span, "wrong-unit",
                to_text(wanted.dimension) + " is wanted here, this is " + to_text(unit->dimension),
                "write it in " + std::string(example_unit(wanted.dimension)));
        }
        return good;
    }

    bool thing(const Expr& value, const Type& wanted) {
        if (value.kind == ExprKind::kCall) {
            const Signature* signature = resolver.signature_of(value.path);
            if (signature == nullptr) {
                unknown(value.path);
                return false;
            }
            Checked<BoundArguments> bound = check_call(file, value, *signature, resolver, element);
            if (!bound) {
                out.insert(out.end(), bound.error().begin(), bound.error().end());
                return false;
            }
            return wanted.thing == "movement" || wanted.kind == TypeKind::kAny ||
                   wrong_type(value, wanted, "a movement");
        }
        if (value.kind != ExprKind::kPath) {
            return wrong_type(value, wanted, "something else");
        }
        const std::optional<Type> found = resolver.type_of(value.path);
        if (!found) {
            unknown(value.path);
            return false;
        }
        return *found == wanted || found->kind == TypeKind::kAny || wanted.kind == TypeKind::kAny ||
               wrong_type(value, wanted, to_text(*found));
    }

    bool word(const Expr& value, const Type& wanted) {
        const bool single = value.kind == ExprKind::kPath && value.path.steps.size() == 1;
        const std::string text = single ? value.path.steps[0].text : to_text(value);
        if (single &&
            std::find(wanted.words.begin(), wanted.words.end(), text) != wanted.words.end()) {
            return true;
        }
        if (single) {  // a parameter of the net may carry the word
            const std::optional<Type> found = resolver.type_of(value.path);
            if (found && *found == wanted) {
                return true;
            }
        }
        out.push_back(unknown_name(file.where(value.span), "choice", text, wanted.words, element));
        return false;
    }

    bool value(const Expr& given, const Type& wanted) {
        switch (wanted.kind) {
            case TypeKind::kNumber:
            case TypeKind::kInteger:
            case TypeKind::kQuantity:
                if (wanted.kind == TypeKind::kInteger && given.kind == ExprKind::kNumber &&
                    !given.number.whole()) {
                    return wrong(given.span, "wrong-type", "a whole number is wanted here",
                                 "round it");
                }
                return quantity(given, wanted);
            case TypeKind::kPoint:
                return point(given, wanted);
            case TypeKind::kText:
                return given.kind == ExprKind::kString ||
                       wrong_type(given, wanted, "'" + to_text(given) + "'");
            case TypeKind::kWord:
                return word(given, wanted);
            case TypeKind::kThing:
                return thing(given, wanted);
            case TypeKind::kBool: {
                if (given.kind == ExprKind::kBool) {
                    return true;
                }
                if (given.kind == ExprKind::kPath) {
                    return thing(given, wanted);
                }
                const bool formula = given.kind == ExprKind::kConditional ||
                                     (given.kind == ExprKind::kUnary && given.op == Op::kNot) ||
                                     (given.kind == ExprKind::kBinary && given.op >= Op::kEqual);
                return formula || wrong_type(given, wanted, "'" + to_text(given) + "'");
            }
            case TypeKind::kAny:
                return true;
        }
        return true;
    }
};

}  // namespace

Diagnostic unknown_name(SourceSpan where, std::string_view kind, std::string_view unknown,
                        std::span<const std::string> known, std::string element) {
    Diagnostic out;
    out.code = "unknown-name";
    out.where = std::move(where);
    out.element = std::move(element);
    out.message = "there is no " + std::string(kind) + " '" + std::string(unknown) + "'";
    const std::string_view nearest = nearest_name(unknown, known);
    if (!nearest.empty()) {
        out.remedy = "did you mean " + std::string(nearest) + "?";
    } else if (!known.empty()) {
        out.remedy = "there are: " + joined(known, 12);
    } else {
        out.remedy = "declare it, or correct the name";
    }
    return out;
}

std::string to_text(const Type& type) {
    switch (type.kind) {
        case TypeKind::kNumber:
            return "a number without unit";
        case TypeKind::kInteger:
            return "a whole number";
        case TypeKind::kBool:
            return "yes or no";
        case TypeKind::kQuantity:
            return to_text(type.dimension);
        case TypeKind::kPoint:
            return "a point (x, y, z) " + std::string(example_unit(type.dimension));
        case TypeKind::kText:
            return "a text in quotes";
        case TypeKind::kWord:
            return "one of " + joined(type.words, 12);
        case TypeKind::kThing:
            return with_article(type.thing);
        case TypeKind::kAny:
            return "anything";
    }
    return "";
}

bool check_value(const File& file, const Expr& value, const Type& type, const Resolver& resolver,
                 const std::string& element, Diagnostics& out) {
    return Check{file, resolver, element, out}.value(value, type);
}

Checked<BoundArguments> check_call(const File& file, const Expr& call, const Signature& signature,
                                   const Resolver& resolver, const std::string& element) {
    Diagnostics defects;
    BoundArguments bound;
    const std::vector<ParameterSignature>& wanted = signature.parameters;
    bound.values.assign(wanted.size(), nullptr);
    std::size_t next = 0;  // the next positional parameter
    std::vector<std::string> names;
    for (const ParameterSignature& parameter : wanted) {
        names.push_back(parameter.name);
    }
    for (const Argument& argument : call.args) {
        std::size_t index = next;
        if (argument.name.text.empty()) {
            ++next;
            if (index >= wanted.size()) {
                if (signature.variadic && !wanted.empty()) {
                    check_value(file, argument.value, wanted.back().type, resolver, element,
                                defects);
                    bound.rest.push_back(&argument.value);
                    continue;
                }
                defects.push_back(defect(
                    file, argument.value.span, "too-many-arguments", element,
                    "'" + signature.name + "' takes at most " + std::to_string(wanted.size()) +
                        " arguments",
                    wanted.empty() ? "leave it out" : "its parameters are " + joined(names, 12)));
                continue;
            }
        } else {
            index = static_cast<std::size_t>(
                std::find(names.begin(), names.end(), argument.name.text) - names.begin());
            if (index == wanted.size()) {
                Diagnostic unknown = unknown_name(file.where(argument.name.span), "parameter",
                                                  argument.name.text, names, element);
                unknown.code = "unknown-argument";
                unknown.message =
                    "'" + signature.name + "' has no parameter '" + argument.name.text + "'";
                defects.push_back(std::move(unknown));
                continue;
            }
        }
        if (bound.values[index] != nullptr) {
            defects.push_back(defect(file, argument.value.span, "repeated-argument", element,
                                     "'" + wanted[index].name + "' is given twice",
                                     "keep one of them"));
            continue;
        }
        bound.values[index] = &argument.value;
        check_value(file, argument.value, wanted[index].type, resolver, element, defects);
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i].required && bound.values[i] == nullptr) {
            defects.push_back(defect(file, call.span, "missing-argument", element,
                                     "'" + signature.name + "' needs '" + wanted[i].name + "', " +
                                         to_text(wanted[i].type),
                                     "add " + wanted[i].name + ": ..."));
        }
    }
    if (!defects.empty()) {
        return Unexpected(std::move(defects));
    }
    return bound;
}

}  // namespace puppetri::lang
