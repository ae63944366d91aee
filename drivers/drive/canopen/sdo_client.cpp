// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/sdo_client.hpp"

namespace cairn::drive::canopen {

void SdoClient::begin(const CanFrame& request, Object object) {
  request_ = request;
  object_ = object;
  attempts_ = 0;
  state_ = State::kBusy;
}

void SdoClient::receive(const CanFrame& frame) {
  if (state_ != State::kBusy || attempts_ == 0 || !frame.is(kSdoResponse + node_)) return;
  const auto response = decode_sdo_response(frame);
  if (!response) {
    // A segmented answer: the object is larger than expedited transfer carries, so it is not the one expected.
    response_ = {SdoResponse::Kind::kAbort, object_, kAbortCommand, 0};
    state_ = State::kAborted;
    return;
  }
  if (response->object != object_) return;
  const bool reading = request_.data[0] == 0x40;
  const bool expected = response->kind == (reading ? SdoResponse::Kind::kValue : SdoResponse::Kind::kWritten);
  if (!expected && response->kind != SdoResponse::Kind::kAbort) return;
  response_ = *response;
  state_ = expected ? State::kDone : State::kAborted;
}

void SdoClient::step(Time now, TxQueue& out) {
  if (state_ != State::kBusy || (attempts_ > 0 && now - sent_ < kTimeout)) return;
  if (attempts_ == kAttempts) {
    out.push(sdo_abort(node_, object_, kAbortTimeout));
    state_ = State::kTimedOut;
    return;
  }
  out.push(request_);
  ++attempts_;
  sent_ = now;
}

}  // namespace cairn::drive::canopen
