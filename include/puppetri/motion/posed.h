// SPDX-License-Identifier: MIT
// Movements that pose joints: by formula, by keyframes, by a clip, by a callback. They differ in
// where the numbers come from (a PoseSource) and in nothing else; here the numbers become a
// movement that joins its neighbours like any other. What a source does not pose goes on standing
// alive: feet stay where they are, hands hang, the chest breathes.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/dof.h"
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// In which space a path of a hand, a foot or the pelvis is given; axes X left, Y up, Z ahead.
//   kChest  the joint upperChest's: goes along with the trunk (hands)
//   kStart  on the floor between the feet, where the figure stands and faces when the movement
//           begins (feet, pelvis)
//   kWorld  the world
enum class PathSpace : std::uint8_t { kChest, kStart, kWorld };

struct DrivenPath {
    Limb limb = Limb::kRightArm;  // an arm, a leg, or the pelvis
    PathSpace space = PathSpace::kChest;
};

// A foot that the source moves stands still in [begin_s, end_s].
struct FootContact {
    Side side = Side::kLeft;
    double begin_s = 0, end_s = 0;
};

// What a source drives. Times are the source's own: a place that prescribes a duration plays it
// faster or slower.
struct PosedSpec {
    std::string name;  // of the movement, for warnings
    double duration_s = 1;
    // Goes on from its beginning after its end, its travel too. A place that gives it more time
    // gets as many whole rounds as come nearest to its own pace; one that gives it less than half a
    // round the beginning of one, or all of it if it has events.
    bool loops = false;
    std::vector<std::string> dofs;    // "head.flex": names of the figure's DOFs
    std::vector<std::string> joints;  // whole rotations of joints, by name in the skeleton
    std::vector<DrivenPath> paths;
    std::vector<std::string> places;  // translations of joints, of figures that are no humanoids
    bool travels = false;             // `joints` has a travel of the root, see PoseFrame
    std::vector<FootContact> contacts;
    struct Event {
        double at_s = 0;
        std::string name;
        Limb limb = Limb::kPelvis;
    };
    std::vector<Event> events;  // within the duration
    double settle_s = 0.35;     // over which the state that was found fades
    // Above 0: what the source says before this time of its own is no motion yet. The figure is on
    // its way from where it was found, and has reached the source's pose then.
    double reached_s = 0;
    // A place that gives it more time than its duration: play slower, or rest at the end.
    bool stretches = true;
    LimbSet also = {};     // what else it drives: limbs that stand alive, unmoved by the source
    bool gets_up = false;  // what the source does not pose stands, also of one who sits
};

// Numbers of one instant, in the order of the spec. Joints' rotations are parent_from_joint of the
// normalised figure.
struct PoseFrame {
    std::span<double> dofs;  // radians or metres
    std::span<Quat> joints;
    std::span<Vec3> paths;  // metres; of a hand the wrist, of a foot the sole below the ankle, of
                            // the pelvis its way from where it stands
    Transform start_from_pelvis;  // where spec.travels: the hips in start space; of a creature, how
                                  // far it has come
    std::span<Vec3> places = {};  // parent_from_joint, metres
};

class PoseSource {
 public:
    virtual ~PoseSource() = default;
    // Fills the frame at t_s in [0, duration]. Cost: no allocation.
    virtual void sample(double t_s, PoseFrame& frame) const = 0;
};

// The limbs that the spec drives: those of its DOFs, joints and paths. A pelvis comes with both
// legs, which then keep the feet on the floor.
LimbSet limbs_of(const figure::Figure& figure, const PosedSpec& spec);

// The limb that a joint of the humanoid belongs to: "leftLowerArm"; none for root and unknown ones.
std::optional<Limb> limb_of_joint(const figure::Figure& figure, std::string_view joint);

// Values outside the DOFs' ranges are taken into them (`check_posed` tells).
// Needs   DOFs and joints of this figure, and a source that fills finite numbers.
MovementPtr make_posed(const MotionContext& context, const PosedSpec& spec,
                       std::shared_ptr<const PoseSource> source);

// Looks at the whole movement 240 times a second, once: a value that is not finite
// ("not-a-number", error) or outside the range of its DOF ("out-of-range", warning, once per DOF).
// Elements read "movement NAME, head.flex at 0.250 s".
Diagnostics check_posed(const figure::DofSet& dofs, const PosedSpec& spec,
                        const PoseSource& source);

}  // namespace puppetri::motion
