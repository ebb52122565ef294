// SPDX-License-Identifier: MIT
// Queueing networks: customers come from sources, wait at stations until a server is free, are
// served, go on along routes, and leave by sinks.
//   queue shop {
//     source door   every exponential(25 s)
//     station chair serves exponential(20 s)
//     sink street
//     door -> chair
//     chair -> street
//   }
// Every node is places and transitions of its own: a customer is one token all the way, waiting in
// chair_queue, served in chair.
#include "kinds.h"
#include "queue_builder.h"

namespace puppetri::notation {

void lower_queue(const lang::Block& block, const lang::File& file, Lowered& out) {
    Teller teller(block, file, out);
    const QueueModel model = read_queue(block, file, teller);
    if (has_errors(out.diagnostics)) {
        return;
    }
    check_queue(model, block, file, teller);
    if (has_errors(out.diagnostics)) {
        return;
    }
    QueueBuilder(model, teller, out.net.body).build();
    // Right after the last one has left: above all that a queue does.
    constexpr std::int64_t kLast = 999'999;
    make_ways("queue", model.ending, kLast, teller, out.net.body);
}

}  // namespace puppetri::notation
