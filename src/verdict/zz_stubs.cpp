// temporary
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/structural_liveness.h"
#include "puppetri/proof/supervisor.h"
#include "puppetri/proof/state_classes.h"
namespace puppetri::proof {
BoundednessAnswer boundedness(const PlainNet&, const Budget&) { return {}; }
TimedLiveness timed_liveness(const net::Net&, const Budget&) { return {}; }
IdentityAnswer conserves_identity(const net::Net&, std::span<const std::uint32_t>, std::span<const std::uint32_t>) { return {}; }
TimedGraph class_graph(const GraphRequest&) { TimedGraph g; g.why_not.push_back("not built"); return g; }
PlaceSet siphon_of_deadlock(const PlainNet&, std::span<const std::uint32_t>) { return {}; }
SupervisorAnswer supervise(const PlainNet&, const LinearSum&, std::int64_t, std::span<const std::uint8_t>) { return {}; }
SupervisorAnswer monitor_siphon(const PlainNet&, const PlaceSet&, std::span<const std::uint8_t>) { return {}; }
}
#include "puppetri/proof/slice.h"
namespace puppetri::proof {
SliceRoots roots_of(const net::Rule&) { return {}; }
DraftSlice component(const net::NetDraft&, const Components&, std::uint32_t) { return {}; }
}
#include "puppetri/proof/components.h"
namespace puppetri::proof {
Components components(const net::NetDraft& d) { Components c; c.of_place.resize(d.places.size(),0); c.of_transition.resize(d.transitions.size(),0); c.count=1; return c; }
}
