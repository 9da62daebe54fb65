; domain.pddl with durations (PDDL 2.1, level 3), in whole seconds as the actions take them on average.
(define (domain kitchen-durative)
  (:requirements :typing :durative-actions)
  (:types place cup)
  (:predicates
    (robot-at ?p - place) (cup-at ?c - cup ?p - place) (holding ?c - cup) (hand-empty) (arm-home) (arm-out)
    (open ?p - place) (free ?p - place))
  (:durative-action navigate
    :parameters (?from ?to - place)
    :duration (= ?duration 9)
    :condition (and (at start (robot-at ?from)) (over all (arm-home)))
    :effect (and (at start (not (robot-at ?from))) (at end (robot-at ?to))))
  (:durative-action reach
    :parameters (?p - place)
    :duration (= ?duration 3)
    :condition (and (over all (robot-at ?p)) (at start (arm-home)))
    :effect (and (at start (not (arm-home))) (at start (arm-out)) (at end (open ?p))))
  (:durative-action fold
    :parameters (?p - place)
    :duration (= ?duration 3)
    :condition (and (over all (robot-at ?p)) (at start (arm-out)))
    :effect (and (at start (not (arm-out))) (at start (not (open ?p))) (at end (arm-home))))
  (:durative-action grip
    :parameters (?c - cup ?p - place)
    :duration (= ?duration 6)
    :condition (and (over all (robot-at ?p)) (at start (open ?p)) (at start (cup-at ?c ?p)) (at start (hand-empty)))
    :effect (and (at start (not (cup-at ?c ?p))) (at start (not (hand-empty))) (at start (not (open ?p)))
                 (at start (not (arm-out))) (at end (holding ?c)) (at end (free ?p)) (at end (arm-home))))
  (:durative-action put
    :parameters (?c - cup ?p - place)
    :duration (= ?duration 6)
    :condition (and (over all (robot-at ?p)) (at start (open ?p)) (at start (holding ?c)) (at start (free ?p)))
    :effect (and (at start (not (holding ?c))) (at start (not (free ?p))) (at start (not (open ?p)))
                 (at start (not (arm-out))) (at end (hand-empty)) (at end (cup-at ?c ?p)) (at end (arm-home)))))
