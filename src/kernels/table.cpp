#include "kernels/kernels.h"

#define ACCRETE_TEXT_OF(name) #name
#define ACCRETE_TEXT(name) ACCRETE_TEXT_OF(name)

extern "C" const accrete::Kernels ACCRETE_TABLE(ACCRETE_ISA) = {
    ACCRETE_TEXT(ACCRETE_ISA),
    ACCRETE_LANE_WIDTH,
    {accrete::extract::load_grey, accrete::extract::load_colour, accrete::extract::round_to_bytes,
     accrete::extract::filter_along, accrete::extract::filter_across, accrete::extract::find_maxima},
    accrete::predict_states,
    accrete::predict_observations,
    accrete::add_incremental_motion_noise,
    {accrete::associate::gate_both_eyes, accrete::associate::gate_one_eye},
    accrete::update_stereo,
    accrete::update_mono,
    accrete::update_reconstructed,
    accrete::update_roll,
    accrete::update_appearance,
};
