# SPDX-License-Identifier: Apache-2.0
cairn_fuzz(gpio_csv gpio_csv_fuzz.cpp LINK cairn_gpio)
