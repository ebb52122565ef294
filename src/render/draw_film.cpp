// SPDX-License-Identifier: MIT
// Pictures drawn by several threads, handed over in order by the caller's. Each thread owns a
// PictureMaker; a ring of slots keeps those that are ahead from running too far.
#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "puppetri/base/require.h"
#include "puppetri/render/film.h"

namespace puppetri::render {
namespace {

class FilmShop {
 public:
    FilmShop(const RenderScene& scene, const FilmFormat& format, int threads)
        : scene_(scene),
          format_(format),
          slots_(static_cast<std::size_t>(2 * threads)),
          next_(format.first_frame),
          handed_(format.first_frame) {}

    // Draws frames until there are none left or somebody stops.
    void work() {
        PictureMaker maker(scene_, format_.width, format_.height);
        for (;;) {
            std::int64_t frame = 0;
            {
                std::unique_lock lock(mutex_);
                room_.wait(lock, [&] {
                    return stopped_ || next_ > format_.last_frame ||
                           next_ < handed_ + static_cast<std::int64_t>(slots_.size());
                });
                if (stopped_ || next_ > format_.last_frame) {
                    return;
                }
                frame = next_++;
            }
            Slot& slot = slot_of(frame);
            const std::optional<SimTime> at = format_.rate.time_of_frame(frame);
            PUP_REQUIRE(at.has_value());
            maker.draw(*at, slot.picture);
            {
                const std::lock_guard lock(mutex_);
                slot.frame = frame;
            }
            drawn_.notify_one();
        }
    }

    FilmStatus hand_over(FrameSink& sink) {
        FilmStatus status = Ok{};
        for (std::int64_t frame = format_.first_frame; frame <= format_.last_frame && status;
             ++frame) {
            Slot& slot = slot_of(frame);
            {
                std::unique_lock lock(mutex_);
                drawn_.wait(lock, [&] { return slot.frame == frame; });
            }
            status = sink.frame(frame, slot.picture);
            {
                const std::lock_guard lock(mutex_);
                handed_ = frame + 1;
                stopped_ = stopped_ || !status;
            }
            room_.notify_all();
        }
        return status;
    }

 private:
    struct Slot {
        Picture picture;
        std::int64_t frame = -1;  // which is in it, finished
    };
    Slot& slot_of(std::int64_t frame) {
        return slots_[static_cast<std::size_t>((frame - format_.first_frame) %
                                               static_cast<std::int64_t>(slots_.size()))];
    }

    const RenderScene& scene_;
    const FilmFormat& format_;
    std::vector<Slot> slots_;
    std::mutex mutex_;
    std::condition_variable room_, drawn_;
    std::int64_t next_, handed_;
    bool stopped_ = false;
};

}  // namespace

FilmStatus draw_film(const RenderScene& scene, const FilmFormat& format, FrameSink& sink) {
    PUP_REQUIRE(format.first_frame >= 0 && format.first_frame <= format.last_frame);
    const auto machine =
        static_cast<std::int64_t>(std::max(1u, std::thread::hardware_concurrency()));
    const std::int64_t wanted = format.threads > 0 ? format.threads : machine;
    const int threads =
        static_cast<int>(std::min(wanted, format.last_frame - format.first_frame + 1));
    FilmShop shop(scene, format, threads);
    std::vector<std::thread> team;
    for (int i = 0; i < threads; ++i) {
        team.emplace_back([&shop] { shop.work(); });
    }
    const FilmStatus status = shop.hand_over(sink);
    for (std::thread& one : team) {
        one.join();
    }
    return status;
}

}  // namespace puppetri::render
