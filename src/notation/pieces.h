// SPDX-License-Identifier: MIT
// Pieces of nets with a beginning and an end, of which event units and scripts are put together:
// the places that get a token when a piece begins, the places that have one when it has ended, and
// all that it has, to be emptied when it is cut.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "make.h"

namespace puppetri::notation {

struct Piece {
    std::string name;
    std::vector<std::string> begins, ends;  // places that get, that have a token
    std::string left;                       // place that gets `rounds` tokens at the beginning
    lang::Expr rounds;
    std::vector<std::string> places;  // all that it has, to empty
    bool never_ends = false;
    bool takes_time = false;  // no zero-time way through it
};

class Pieces {
 public:
    explicit Pieces(lang::Body& body) : body_(body) {}

    // A place of the piece; gives its name.
    std::string place(Piece& piece, const std::string& name, lang::Span where,
                      bool is_public = false) {
        lang::Place made = make_place(make_name(name, where));
        made.is_public = is_public;
        body_.places.push_back(std::move(made));
        piece.places.push_back(name);
        return name;
    }

    // A transition from places to places, not yet in the net.
    lang::Transition join(const std::string& name, const std::vector<std::string>& from,
                          lang::Span where, const std::vector<std::string>& to = {}) {
        std::vector<lang::Path> in, out;
        for (const std::string& p : from) {
            in.push_back(make_path(p, where));
        }
        for (const std::string& p : to) {
            out.push_back(make_path(p, where));
        }
        lang::Transition t = make_transition(make_name(name, where), std::move(in), std::move(out));
        t.span = where;
        t.is_public = true;
        return t;
    }

    // It begins the piece as well.
    void begin_piece(lang::Transition& t, const Piece& piece) {
        for (const std::string& p : piece.begins) {
            t.outputs.push_back(make_arc(lang::ArcKind::kGive, make_path(p, t.span),
                                         p == piece.left ? piece.rounds : lang::Expr{}));
        }
    }

    // It takes whatever the piece has, ready or not, but from these places.
    void empty_piece(lang::Transition& t, const Piece& piece,
                     const std::vector<std::string>& except = {}) {
        for (const std::string& p : piece.places) {
            if (std::find(except.begin(), except.end(), p) == except.end()) {
                t.inputs.push_back(make_arc(lang::ArcKind::kTakeAllNow, make_path(p, t.span)));
            }
        }
    }

    static void absorb(Piece& piece, const Piece& inner) {
        piece.places.insert(piece.places.end(), inner.places.begin(), inner.places.end());
    }

    // A unit made of others is true, for rules, while any of its places has a token.
    void name_state(const Piece& piece, const lang::Caption& caption, lang::Span where) {
        if (piece.places.empty() || piece.name.empty()) {
            return;
        }
        lang::State state;
        state.name = make_name(piece.name, where);
        state.caption = caption;
        state.is_public = true;
        state.span = where;
        state.formula = make_any(piece.places, where);
        body_.states.push_back(std::move(state));
    }

 protected:
    lang::Body& body_;
};

}  // namespace puppetri::notation
