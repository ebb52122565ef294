// SPDX-License-Identifier: MIT
// Elaboration: from syntax trees to one flat draft of a net, a cast and a list of actions. Nets are
// instantiated first (a tree of instances, each with a table of its members), so that afterwards
// everything can be named from everywhere in any order; then each kind of statement is completed in
// one pass. Every defect is told and replaced by Nothing, which agrees with everything, so that one
// defect gives one message. One .cpp per concept; this header is their common table.
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "library.h"
#include "puppetri/figure/linkage.h"
#include "puppetri/motion/clip_movement.h"
#include "puppetri/motion/formula_movement.h"
#include "puppetri/motion/library.h"
#include "puppetri/motion/own_movement.h"
#include "puppetri/net/draft.h"
#include "puppetri/scene/assets.h"
#include "puppetri/scene/scene.h"
#include "term.h"

namespace puppetri::scene {

// One variable of a `for` with its present value; a chain outwards.
struct LoopBinding {
    std::string name;
    Term value;
    std::string text;  // as a part of names: "a", "3"
    const LoopBinding* up = nullptr;
};

// Names of one statement: variables of a transition, attributes of a place's token.
struct Locals {
    net::SlotKind kind = net::SlotKind::kVariable;
    std::vector<net::VariableDraft> names;
};

// Where a statement stands, hence what its names mean.
struct Scope {
    std::uint32_t instance = 0;
    const LoopBinding* loop = nullptr;
    const Locals* locals = nullptr;
    bool sees_all = false;  // rules and cameras see what is not public, too
};

struct Function;  // functions.h

// A movement that a file defines; `movement` is null where something is wrong with it.
struct OwnDefinition {
    const lang::Block* block = nullptr;
    motion::OwnMovementPtr movement = {};
    std::shared_ptr<const motion::FormulaMaker> formula = {};  // of a movement by formula
    std::shared_ptr<const motion::ClipMaker> clip = {};        // of a clip
    Diagnostics no_humanoid = {};        // of a clip: why humanoids cannot play it
    bool humanoid = true;                // its DOFs are those of humanoids
    std::vector<std::string> dofs = {};  // that it drives, and where it says so
    std::vector<lang::Span> dof_spans = {};
    std::vector<std::string> events = {};  // that it raises

    // Fills what it drives: limbs, and whether it may be an argument.
    void limbs_of_definition(motion::OwnSignature& signature, const motion::PosedSpec& spec);
};

enum class MemberKind : std::uint8_t {
    kPlace,
    kTransition,
    kState,
    kDatum,
    kEvent,
    kChannel,
    kInstance,
    kEnumeration
};

struct Member {
    MemberKind kind = MemberKind::kPlace;
    std::uint32_t index = 0;
    bool is_public = false;
};

inline constexpr std::uint32_t kNoInstance = ~std::uint32_t{0};

// A net with its parameters, or the scene itself (number 0).
struct Instance {
    const lang::Net* net = nullptr;  // null: the scene's own body
    const lang::Body* body = nullptr;
    std::uint32_t file = 0;
    std::string path;                // "a.with_ball"; empty: the scene
    std::uint32_t up = kNoInstance;  // whose body it was made in
    net::PlaceIndex refines;         // the place that runs it, if any
    lang::Span where;                // of the use
    Scope argument_scope;
    std::vector<const lang::Expr*> arguments;  // by parameter; null: its default
    enum class Bound : std::uint8_t { kNo, kNow, kYes };
    std::vector<std::pair<Bound, Term>> values;  // by parameter, bound when first asked for
    std::map<std::string, Member, std::less<>> members;
    const lang::Block* equations = nullptr;  // the block that it was made from
    bool stand_in = false;                   // parameters that were not given stand for anything
};

// A statement of an instance, in its scope.
template <class Node>
struct Element {
    const Node* node = nullptr;
    Scope scope;
    std::string path;
};

struct PlaceElement : Element<lang::Place> {
    Locals attributes;
    const std::vector<lang::Parameter>* declared = nullptr;  // the attributes, with their defaults
    std::uint32_t runs = kNoInstance;
    net::ActionIndex action;
    std::vector<stage::RaisedName> raises;  // events of its movement that somebody listens to
};

struct StateElement : Element<lang::State> {
    enum class Known : std::uint8_t { kNo, kNow, kYes } known = Known::kNo;
    net::Formula formula;
};

// What a name is looked up for among the declarations that a file can see.
enum class Wanted : std::uint8_t { kNet, kTokenType };

// The operator of the kernel that an operator of the language is. Needs one of two operands that is
// no interval and not temporal.
ExprOp kernel_op(lang::Op op);  // expressions.cpp

// An attribute as tokens have it, without quotes, of a binding `'its kind' = 3`.
std::string attribute_name(const lang::Path& name);  // data.cpp

class Elaboration {
 public:
    explicit Elaboration(const Library& library) : library_(library) {}

    // The scene of file 0.
    void elaborate_scene();
    // One net alone, with stand-ins for its parameters.
    void elaborate_alone(const Declaration& net);

    // Whether this net was instantiated.
    bool used(const lang::Net& net) const { return used_.count(key(net.span)) != 0; }

    Scene scene;  // but for `net`
    Diagnostics diagnostics;
    // Statements that have an error: what is said about them further on is a consequence.
    std::set<std::pair<std::string, std::uint32_t>> broken_lines;

 private:
    friend class About;
    friend class ClipBlock;
    friend class FormulaBlock;
    friend class EquationsBlock;
    friend class FormulaCompiler;

    // telling.cpp
    void tell(Severity severity, std::string code, lang::Span where, std::string message,
              std::string remedy);
    void error(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(Severity::kError, std::move(code), where, std::move(message), std::move(remedy));
    }
    void warn(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(Severity::kWarning, std::move(code), where, std::move(message), std::move(remedy));
    }
    void unknown(lang::Span where, std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known);
    void wrong(lang::Span where, const std::string& wanted, const Term& got,
               std::string remedy = "");
    // A node of the trees, told by where it stands.
    using NodeKey = std::pair<std::uint32_t, std::uint32_t>;
    static NodeKey key(lang::Span span) { return {span.file, span.begin}; }
    net::NetDraft& draft() { return scene.draft; }
    SourceSpan at(lang::Span span) const { return library_.where(span); }

    // instances.cpp -- the tree of nets
    std::uint32_t make_instance(const Declaration& net, std::string path, lang::Span where,
                                Scope scope, const std::vector<lang::Argument>& arguments,
                                net::PlaceIndex refines);
    void expand(std::uint32_t instance);
    void expand_body(const lang::Body& body, const Scope& scope);
    void unroll(const lang::For& loop, const Scope& scope);
    void declare_holding(std::uint32_t transition);
    void instantiate();
    std::uint32_t enumeration_index(const lang::Enumeration& e);
    void match_arguments(Instance& instance, const std::vector<lang::Argument>& arguments);
    bool add_member(const Scope& scope, const lang::Name& name, Member member);
    std::string key_of(const lang::Name& name, const Scope& scope);
    std::string path_of(const lang::Name& name, const Scope& scope);
    std::optional<Declaration> find_declaration(const lang::Path& path, std::uint32_t file,
                                                Wanted kind);

    // parameters.cpp -- their types and values
    Term parameter_value(std::uint32_t instance, std::size_t parameter);
    Term fit_parameter(const lang::Parameter& parameter, Term value, lang::Span where,
                       const Scope& scope);
    std::optional<ValueType> value_type(const lang::Expr& type, const Scope& scope,
                                        std::optional<Value>* low = nullptr,
                                        std::optional<Value>* high = nullptr);

    // names.cpp -- what a path stands for
    Term resolve(const lang::Path& path, const Scope& scope);
    std::optional<Term> resolve_first(const lang::Name& name, const Scope& scope);
    Term resolve_next(const Term& before, const lang::Name& name, const Scope& scope);
    Term member_term(const Member& member);
    std::vector<std::string> names_in(const Scope& scope);
    std::optional<Term> cast_member(std::string_view name, std::uint32_t file);
    net::HostAtomIndex host_atom(net::HostAtom::Kind kind, std::string subject, std::string value,
                                 lang::Span where);
    net::EventIndex movement_event(net::PlaceIndex place, const lang::Name& name);

    // constants.cpp, expressions.cpp -- what an expression stands for
    Term evaluate(const lang::Expr& e, const Scope& scope);
    Term evaluate_unary(const lang::Expr& e, const Scope& scope);
    Term evaluate_binary(const lang::Expr& e, const Scope& scope);
    Term evaluate_path(const lang::Expr& e, const Scope& scope);
    Term evaluate_logic(const lang::Expr& e, const Scope& scope);
    Term evaluate_call(const lang::Expr& e, const Scope& scope);
    Term call_function(const lang::Expr& e, const Function& function, const Scope& scope);
    // sensors.cpp -- questions to the figures: distance(ana.right_hand, ball) < 0.3 m
    static bool is_sensor_function(std::string_view name);
    Term sensor_quantity(const lang::Expr& e, const Scope& scope);
    Term sensor_comparison(const lang::Expr& e, lang::Op op, const Term& a, const Term& b);
    Term sensor_datum(stage::Sensor sensor, lang::Span where);
    std::optional<stage::SensorPoint> sensor_point(const lang::Expr& e, const Scope& scope);
    Term evaluate_tuple(const lang::Expr& e, const Scope& scope);
    bool is_unknown_name(const lang::Expr& e, const Scope& scope);
    // The value of that name of the enumeration that the data are of.
    std::optional<Term> value_beside(const lang::Expr& name, const Term& data);
    Term fold(const lang::Expr& e, lang::Op op, const Term& a, const Term& b);
    Term fold_numbers(const lang::Expr& e, lang::Op op, const Number& a, const Number& b);
    Term compare_things(const lang::Expr& e, const Term& a, const Term& b);
    std::optional<FrameRate> frame_rate_of(std::uint32_t file);
    Term number_of(const lang::Expr& e, const Rational& number, const std::string& unit,
                   lang::Span where);
    std::optional<Number> constant_number(const lang::Expr& e, const Scope& scope,
                                          lang::Dimension dimension, std::string_view what);
    std::optional<std::int64_t> constant_integer(const lang::Expr& e, const Scope& scope,
                                                 std::string_view what);
    std::optional<SimTime> constant_time(const lang::Expr& e, const Scope& scope,
                                         std::string_view what);
    // Seconds to ticks, once, with a note where that rounds.
    std::optional<SimTime> ticks(const Number& seconds, lang::Span where);
    // A plain number where a time is wanted takes the file's unit of time.
    Number in_time_unit(const Number& n, lang::Span where);
    // As an expression of the kernel; nullopt when it is none (told) or Nothing.
    std::optional<Expr> as_expr(const Term& term, lang::Span where);
    std::optional<Expr> as_expr_of(const Term& term, ValueType type, lang::Span where);
    std::optional<Expr> expr_of(const lang::Expr& e, const Scope& scope, ValueType type);
    std::optional<Expr> apply(ExprOp op, std::vector<Expr> operands, lang::Span where);

    // formulas.cpp -- statements about the net
    std::optional<net::Formula> as_formula(const Term& term, lang::Span where);
    net::Formula formula_of(const lang::Expr& e, const Scope& scope);
    std::optional<Expr> expr_of_formula(const net::Formula& formula, lang::Span where);
    net::Formula state_formula(std::uint32_t state);
    // A formula of branching or linear time: calls AG EF AX ..., G F X, and until.
    net::Formula temporal_formula(const lang::Expr& e, const Scope& scope, bool linear);

    // cast.cpp -- actors, props, sets, cameras
    Term add_cast_member(const lang::CastMember& member);
    void fill_figure(const lang::CastMember& member, const Scope& scope, stage::Actor& actor);
    void fill_prop(const lang::CastMember& member, const Scope& scope, stage::Prop& prop);
    // Where it stands and how it looks, of every kind of actor; gives whether it was such a
    // property.
    bool place_figure(const lang::Property& property, const Scope& scope, stage::Actor& actor);
    void fill_set(const lang::CastMember& member, const Scope& scope, stage::Set& set);
    Term holder_actor(const lang::Expr& e, const Scope& scope);
    void add_camera(const lang::Block& block);
    void keep_in_view(const lang::Expr& e, const Scope& scope, Camera& camera);
    std::optional<Vec3> point_of(const lang::Expr& value, const Scope& scope);
    std::optional<double> quantity_of(const lang::Property& property, const Scope& scope,
                                      lang::Dimension dimension, const char* form);
    std::optional<std::string> palette_of(const lang::Property& property);
    bool has_values(const lang::Property& property, std::size_t count, const char* form);
    void unknown_property(const lang::Property& property, const std::vector<std::string>& known);
    // cast_characters.cpp -- actors out of files
    void fill_character(const lang::CastMember& member, const Scope& scope, stage::Actor& actor);
    std::vector<NamedBone> bones_of(const lang::Property& property);
    static std::shared_ptr<const figure::Character> stand_in_character();
    void load_character(const lang::CastMember& member, CharacterRequest& request,
                        stage::Actor& actor);
    // cast_linkages.cpp -- figures put together in the scene
    void fill_linkage(const lang::CastMember& member, const Scope& scope, stage::Actor& actor);
    std::optional<figure::Link> link_of(const lang::Property& property, const Scope& scope,
                                        const std::vector<figure::Link>& before);
    std::optional<figure::LinkDof> link_dof(const lang::Property& property, const Scope& scope);
    std::optional<figure::LinkShape> link_shape(const lang::Property& property, const Scope& scope);
    void complete_cast();
    void check_cast();
    void complete_blocks();

    // data.cpp, places.cpp, durations.cpp, actions.cpp, transitions.cpp, events.cpp, rules.cpp --
    // the passes
    void complete_data();
    void complete_attributes();
    void complete_places();
    void complete_place(std::size_t index);
    void complete_tokens(std::size_t index);
    std::optional<std::vector<Expr>> bind_attributes(const std::vector<lang::Binding>& given,
                                                     net::PlaceIndex place, const Scope& scope,
                                                     lang::Span where,
                                                     std::string_view except = "");
    net::DurationDraft duration_of(const lang::Expr& e, const Scope& scope);
    net::DurationDraft distribution_of(const lang::Expr& e, const Scope& scope);
    net::DurationDraft sample_distribution(const lang::Expr& e, const Scope& scope,
                                           net::DurationDraft out);
    std::optional<motion::BoundCall> bind_call(const lang::Expr& call, const Scope& scope);
    // `side_later`: a `side` that is not given is that of the limb that will do it.
    void bind_arguments(const lang::Expr& call, const motion::MovementSignature& signature,
                        const Scope& scope, motion::BoundCall& out, bool side_later = false);
    std::optional<motion::BoundCall> done_by(const motion::Subject& subject, motion::BoundCall call,
                                             lang::Span where);
    const MovementTerm* given_movement(const lang::Expr& call, const Scope& scope);
    void check_stand_in_call(const lang::Expr& call, const Scope& scope);
    std::optional<motion::ArgumentValue> bind_argument(const lang::Expr& value,
                                                       const motion::Parameter& parameter,
                                                       const Scope& scope, motion::BoundCall& out);
    Term movement_value(const lang::Expr& e, const lang::Path& path, const Scope& scope);
    // own_movements.cpp -- movements that files define
    const OwnDefinition* own_movement(std::string_view name, std::uint32_t file);
    const OwnDefinition& define_movement(const lang::Block& block);
    OwnDefinition define_clip(const lang::Block& block);  // clip_block.cpp
    std::string read_own_parameters(
        const lang::Block& block, motion::OwnSignature& signature,
        const std::function<void(const std::string&, motion::ParameterType, lang::Dimension)>& add);
    void check_own_call(const OwnDefinition& definition, const motion::BoundCall& call,
                        lang::Span where);
    void check_clip_call(const OwnDefinition& definition, const motion::BoundCall& call,
                         lang::Span where);
    // A movement that may be an argument of others: `carry` in `arms: carry(ball)`.
    bool is_argument_movement(std::string_view name, std::uint32_t file);
    std::vector<std::string> own_movement_names(std::uint32_t file) const;
    void complete_transitions();
    void complete_transition(std::size_t index);
    void complete_arcs(std::size_t index, Locals& locals);
    std::optional<net::PlaceIndex> place_of(const lang::Path& path, const Scope& scope);
    void bind_patterns(const lang::Arc& arc, Locals& locals, const Scope& scope,
                       net::ArcDraft& out);
    void complete_rendezvous();
    // channels.cpp, polls.cpp -- machines that speak to each other
    void declare_channels();
    void complete_channels();
    void complete_send(std::uint32_t transition);
    void complete_receive(std::uint32_t transition);
    const ChannelTerm* channel_of(const lang::Path& path, const Scope& scope, Term& term);
    std::uint32_t machine_of(std::uint32_t instance) const;
    void find_polls();
    // A name that stands for a value of this enumeration as well as for something of the net.
    std::optional<Expr> enum_value(const lang::Expr& e, const Term& otherwise, ValueType type);
    void complete_events();
    void complete_equations();  // equations_block.cpp
    // What measures may name of equations, by the instance and the name there.
    struct Course {
        net::CourseQuantity quantity;
        lang::Dimension dimension;
    };
    // Whether that is a variable of equations, which nets do not read; tells it then.
    bool told_continuous(const Instance& instance, const lang::Name& name);
    void complete_refinements();
    void complete_states();
    void complete_rules();
    void complete_rule(const Element<lang::Rule>& rule);
    void complete_question(const Element<lang::Question>& question);
    // measures.cpp
    void complete_measures();
    void complete_measure(const Element<lang::Measure>& measure);
    std::optional<Expr> seen_value(const lang::Expr& e, const Scope& scope, bool truth);
    const Course* course_of(const lang::Expr& e, const Scope& scope);
    std::optional<net::TransitionIndex> moment_of(const lang::Path& path, const Scope& scope,
                                                  Locals& locals);
    std::vector<net::Moment> moments_of(const std::vector<lang::Moment>& list, const Scope& scope);
    void name_elements(const lang::Rule& node, const Scope& scope, net::Rule& out);
    net::Formula moves_of(motion::ActorIndex actor);
    void complete_ends();
    void complete();
    void read_header();

    const Library& library_;
    std::string element_;  // what is being looked at
    lang::Span statement_;
    bool reading_rate_ = false;
    bool reading_distribution_ = false;  // whose parameters need be no whole number of ticks
    std::set<std::tuple<std::string, std::uint32_t, std::uint32_t>> told_;
    std::set<NodeKey> used_;

    std::deque<Instance> instances_;
    std::vector<std::uint32_t> to_expand_;
    std::vector<std::pair<const lang::For*, Scope>> to_unroll_;
    std::deque<LoopBinding> loop_bindings_;  // addresses stay
    // Parallel to the lists of the draft.
    std::deque<PlaceElement> places_;
    std::vector<Element<lang::Transition>> transitions_;
    std::deque<StateElement> states_;
    std::vector<Element<lang::Data>> data_;
    std::vector<Element<lang::Event>> events_;  // movement events have no node
    std::vector<Element<lang::Channel>> channels_;
    std::vector<std::optional<ValueType>> channel_types_;  // none: of signals, or wrong
    std::vector<Element<lang::Rule>> rules_;
    std::vector<Element<lang::Question>> questions_;
    std::vector<Element<lang::Measure>> measures_;
    std::map<std::pair<std::uint32_t, std::string>, Course> courses_;
    std::vector<Element<lang::End>> ends_;  // one per formula list
    std::vector<std::pair<const lang::EventFile*, Scope>> event_files_;
    std::vector<std::pair<const lang::Block*, Scope>> blocks_;
    std::map<std::pair<std::uint32_t, std::string>, Term>
        cast_;  // by file and name, added on demand
    std::map<std::string, lang::Span> cast_where_;
    std::map<NodeKey, std::uint32_t> enumerations_;
    std::map<NodeKey, OwnDefinition> own_movements_;  // by block
    std::map<std::string, OwnDefinition, std::less<>> host_movements_;
};

// Says for a while what is being looked at, for messages.
class About {
 public:
    About(Elaboration& elaboration, std::string element, lang::Span statement)
        : elaboration_(elaboration),
          element_(std::exchange(elaboration.element_, std::move(element))),
          statement_(std::exchange(elaboration.statement_, statement)) {}
    ~About() {
        elaboration_.element_ = std::move(element_);
        elaboration_.statement_ = statement_;
    }
    About(const About&) = delete;
    About& operator=(const About&) = delete;

 private:
    Elaboration& elaboration_;
    std::string element_;
    lang::Span statement_;
};

}  // namespace puppetri::scene
