// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
